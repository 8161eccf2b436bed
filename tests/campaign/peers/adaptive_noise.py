"""Computes the fusion of a run again, with adaptive noise, and compares each step with TRACK.

    adaptive_noise.py build/bin/fogline scenario/dense_fog.json

This script has a Kalman filter in information form: it adds the information (the inverse of the
covariance) of the prediction and of the measured value. So it does not use Fogline's formula of
the gain. The sensors must have no lateral offsets.
"""

import statistics
import sys

from exported_run import Differences, Run

# A relative tolerance. The inverse of a covariance with entries from 1e-4 to 1e3 loses some digits.
TOLERANCE = 1e-7
CASES = {
    "innovation": ["/fusion/adaptive_noise=innovation"],
    "residual": ["/fusion/adaptive_noise=residual"],
    "residual, long memory": ["/fusion/adaptive_noise=residual", "/fusion/noise_forgetting=0.95"],
    "innovation, gate": ["/fusion/adaptive_noise=innovation", "/fusion/gating=true"],
    "residual, gate that never reopens": ["/fusion/adaptive_noise=residual", "/fusion/gating=true",
                                          "/fusion/gate_reopen_after=0"],
    "none": [],
}
USED, GATED = 1, 2


def times(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def plus(a, b):
    return [[x + y for x, y in zip(row, other)] for row, other in zip(a, b)]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    adjugate = [[e * i - f * h, c * h - b * i, b * f - c * e],
                [f * g - d * i, a * i - c * g, c * d - a * f],
                [d * h - e * g, b * g - a * h, a * e - b * d]]
    determinant = a * adjugate[0][0] + b * adjugate[1][0] + c * adjugate[2][0]
    return [[x / determinant for x in row] for row in adjugate]


class Filter:
    """The state is [distance, relative speed, acceleration of the car ahead].

    The measured values have the numbers of TRACK: 0 is the radar's range, 1 the radar's range rate,
    2 the LiDAR's range."""

    def __init__(self, scenario):
        fusion = scenario["fusion"]
        h = scenario["step_s"]
        q = fusion["jerk_density_m2ps5"]
        self.transition = [[1, h, h * h / 2], [0, 1, h], [0, 0, 1]]
        self.input = [-h * h / 2, -h, 0]
        self.process = [[q * h**5 / 20, q * h**4 / 8, q * h**3 / 6],
                        [q * h**4 / 8, q * h**3 / 3, q * h**2 / 2],
                        [q * h**3 / 6, q * h**2 / 2, q * h]]
        self.assumed = [fusion["radar_range_std_m"]**2, fusion["radar_range_rate_std_mps"]**2,
                        fusion["lidar_range_std_m"]**2]
        self.noise = list(self.assumed)
        self.start_acceleration = fusion["initial_acceleration_std_mps2"]**2
        self.rule = fusion["adaptive_noise"]
        self.keep = fusion["noise_forgetting"]
        self.gate = None
        if fusion["gating"]:
            self.gate = statistics.NormalDist().inv_cdf((1 + fusion["gate_probability"]) / 2)**2
        self.reopen = fusion["gate_reopen_after"]
        self.refused = [0, 0, 0]
        self.x = None

    def start(self, radar):
        self.x = [radar["range_m"], radar["range_rate_mps"], 0.0]
        self.p = [[self.assumed[0], 0, 0], [0, self.assumed[1], 0], [0, 0, self.start_acceleration]]

    def predict(self, acceleration):
        self.x = [sum(f * x for f, x in zip(row, self.x)) + b * acceleration
                  for row, b in zip(self.transition, self.input)]
        self.p = plus(times(times(self.transition, self.p), transposed(self.transition)), self.process)

    def admits(self, value, ratio):
        if self.gate is None or ratio <= self.gate:
            self.refused[value] = 0
            return True
        if self.reopen and self.refused[value] >= self.reopen:
            return True
        self.refused[value] += 1
        return False

    def correct(self, value, measured):
        """Returns innovation, its variance, and whether the value was used."""
        k = 1 if value == 1 else 0  # the element of the state that is measured
        before = self.p[k][k]
        innovation = measured - self.x[k]
        variance = before + self.noise[value]
        if not self.admits(value, innovation**2 / variance):
            return innovation, variance, False
        information = inverse(self.p)
        vector = [sum(i * x for i, x in zip(row, self.x)) for row in information]
        information[k][k] += 1 / self.noise[value]
        vector[k] += measured / self.noise[value]
        self.p = inverse(information)
        self.x = [sum(p * v for p, v in zip(row, vector)) for row in self.p]
        seen = None
        if self.rule == "innovation":
            seen = innovation**2 - before
        elif self.rule == "residual":
            seen = (measured - self.x[k])**2 + self.p[k][k]
        if seen is not None:
            learnt = self.keep * self.noise[value] + (1 - self.keep) * seen
            self.noise[value] = max(self.assumed[value], learnt)
        return innovation, variance, True


def compare(run, differences):
    peer = Filter(run.scenario)
    for k, (ego, radar, lidar, track) in enumerate(zip(run.HOST_EGO, run.RADAR, run.LIDAR, run.TRACK)):
        values = {}
        if peer.x is not None:
            peer.predict(ego["acceleration_mps2"])
            if radar["valid"]:
                values = {0: radar["range_m"], 1: radar["range_rate_mps"]}
        else:
            assert radar["valid"], "the radar starts the track in these scenarios"
            peer.start(radar)
        if lidar["valid"]:
            values[2] = lidar["range_m"]
        for value, measured in values.items():
            innovation, variance, used = peer.correct(value, measured)
            name = f"step {k}, value {value}"
            differences.expect(track[f"usage.{value}"] == (USED if used else GATED), f"{name}: usage")
            differences.expect_near(track[f"innovation.{value}"], innovation, TOLERANCE, f"{name}: innovation")
            differences.expect_near(track[f"innovation_variance.{value}"], variance, TOLERANCE, f"{name}: variance")
        differences.expect_near(track["state.0"], peer.x[0], TOLERANCE, f"step {k}: distance")
        differences.expect_near(track["state.1"], peer.x[1], TOLERANCE, f"step {k}: relative speed")
        for i in range(3):
            for j in range(3):
                differences.expect_near(track[f"covariance.{3 * i + j}"], peer.p[i][j], TOLERANCE,
                                        f"step {k}: covariance {i} {j}")
    return peer.noise


def main(fogline, scenario):
    differences = Differences()
    for name, fields in CASES.items():
        run = Run(fogline, scenario, fields)
        noise = compare(run, differences)
        print(f"{name}: {len(run.TRACK)} steps, last standard deviations", [f"{r**0.5:.3g}" for r in noise])
    return differences.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
