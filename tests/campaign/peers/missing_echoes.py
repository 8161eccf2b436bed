"""Counts the modes of the LiDAR under fog model `modes`, and compares with the scenario's
probabilities.

    missing_echoes.py build/bin/fogline scenario/dense_fog.json

The gap varies between 21 m and 45 m. The filter trusts the LiDAR so little that the host does not
react to the LiDAR.
"""

import sys

from exported_run import Differences, Run

SEEDS = range(1, 7)
FIELDS = ["/fog/model=modes", "/fog/profile=half_sine", "/fog/start_s=0", "/fog/duration_s=400", "/steps=4000",
          "/fog/bias_m=5", "/fusion/lidar_range_std_m=10", "/fusion/radar_range_std_m=0.05",
          "/arbitrator/policy=none", "/lead/profile=sinusoid", "/lead/sinusoid/amplitude_mps=8",
          "/lead/sinusoid/period_s=100"]
SHARES = {
    "missing alone": ["/fog/modes/missing_share=1"],
    "mixture": ["/fog/modes/missing_share=0.6", "/fog/modes/near_echo_share=0.2", "/fog/modes/biased_share=0.15"],
    "other ranges": ["/fog/modes/missing_share=0.9", "/fog/modes/missing_from_m=30",
                     "/fog/modes/missing_beyond_m=32"],
}
BINS = [(0, 25), (25, 30), (30, 35), (35, 100)]
# By the normal distribution, the probability that one of the 18 counts is more than 5.6 standard
# deviations from its mean is below one in a million.
SIGMAS = 5.6


def missing_probability(modes, gap, level):
    start, end = modes["missing_from_m"], modes["missing_beyond_m"]
    rise = 0.0 if gap <= start else 1.0 if gap >= end else (gap - start) / (end - start)
    return level * modes["missing_share"] * rise


class Count:
    """The number of events, and the mean and the variance that are expected for this number."""

    def __init__(self):
        self.steps = self.seen = 0
        self.mean = self.variance = 0.0

    def add(self, happened, probability):
        self.steps += 1
        self.seen += happened
        self.mean += probability
        self.variance += probability * (1 - probability)

    def fits(self):
        return abs(self.seen - self.mean) <= SIGMAS * self.variance**0.5 + 1e-6


def main(fogline, scenario):
    differences = Differences()
    for name, shares in SHARES.items():
        missing = {interval: Count() for interval in BINS}
        near = Count()
        biased = Count()
        for seed in SEEDS:
            run = Run(fogline, scenario, FIELDS + shares + [f"/seed={seed}"])
            modes = run.scenario["fog"]["modes"]
            noise = 6 * run.scenario["lidar"]["range_std_m"]
            for truth, lidar in zip(run.TRUTH, run.LIDAR):
                gap, level = truth["host_gap_m"], truth["fog_level"]
                interval = next(i for i in BINS if i[0] <= gap < i[1])
                missing[interval].add(not lidar["valid"], missing_probability(modes, gap, level))
                error = lidar["range_m"] - gap if lidar["valid"] else None
                is_near = lidar["valid"] and lidar["range_m"] < 12
                is_biased = lidar["valid"] and abs(error + run.scenario["fog"]["bias_m"]) < noise
                near.add(is_near, level * modes["near_echo_share"])
                biased.add(is_biased, level * modes["biased_share"])
                right = lidar["valid"] and abs(error) < noise
                differences.expect(not lidar["valid"] or is_near or is_biased or right,
                                   f"{name}: {lidar['range_m']} m is no mode of a gap of {gap} m")
        for what, count in [*((f"missing at {i[0]} to {i[1]} m", c) for i, c in missing.items()),
                            ("near echo", near), ("biased", biased)]:
            print(f"{name}, {what}: {count.seen} of {count.steps}, expected {count.mean:.1f} +- "
                  f"{count.variance**0.5:.1f}")
            differences.expect(count.fits(), f"{name}, {what}")
    return differences.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
