"""Computes from the messages of a run when the host and the following cars brake in an emergency,
and compares the result with the run.

    emergency_braking.py build/bin/fogline scenario/dense_fog.json

The host uses its fused track. The following cars have ACCs here, and use the truth.
"""

import sys

from exported_run import Differences, Run

# The host's ACC can brake only with 0.1 m/s2. The host approaches a slow car, so it needs its
# emergency braking. Two cars follow the host.
SLOW_CAR = ["/lead/speed_mps=8", "/world/host_gap_m=40", "/world/follower_gap_m=8", "/followers/count=2",
            "/world/end_on_collision=false", "/acc/min_acceleration_mps2=-0.1", "/aeb/enabled=true",
            "/followers/aeb/enabled=true", "/steps=300"]
CASES = {
    "clear air": ["/fog/model=none"],
    "fog": ["/fog/start_s=0", "/fog/duration_s=20"],
    "by deceleration": ["/fog/model=none", "/aeb/trigger=deceleration", "/aeb/required_mps2=3",
                        "/followers/aeb/trigger=either", "/aeb/warning_s=2"],
    "both, driver brakes": ["/fog/model=none", "/aeb/trigger=both", "/arbitrator/threshold=0",
                            "/driver/max_deceleration_mps2=1"],
    "vehicles on ice": ["/fog/model=none", "/host_vehicle/model=longitudinal", "/road/surface=ice",
                        "/aeb/release_closing_mps=1"],
}
AUTOMATION, HUMAN, WARNING, BRAKING = 0, 1, 11, 12


class System:
    """One car's system. `danger` gives the state for a gap, a closing speed and the own speed."""

    def __init__(self, section):
        self.section = section
        self.braking = False

    def imminent(self, gap, closing):
        time = gap / closing <= self.section["ttc_s"]
        braking = gap <= 0 or closing**2 / (2 * gap) >= self.section["required_mps2"]
        return {"ttc": time, "deceleration": braking, "either": time or braking,
                "both": time and braking}[self.section["trigger"]]

    def danger(self, gap, closing, speed):
        closes = gap is not None and closing > self.section["release_closing_mps"]
        if self.braking:
            self.braking = closes and speed > 0
        if self.braking:
            return "braking"
        active = self.section["min_speed_mps"] <= speed <= self.section["max_speed_mps"]
        if not closes or not active:
            return "ready"
        self.braking = self.imminent(gap, closing)
        if self.braking:
            return "braking"
        return "warning" if self.imminent(gap - self.section["warning_s"] * closing, closing) else "ready"


def compare_host(run, differences):
    section = run.scenario["aeb"]
    limit = run.scenario["acc"]["max_track_std_m"]**2
    system = System(section)
    counts = {"ready": 0, "warning": 0, "braking": 0}
    rows = zip(run.HOST_EGO, run.TRACK, run.ACC_COMMAND, run.DRIVER_COMMAND, run.HOST_COMMAND)
    for k, (ego, track, acc, driver, command) in enumerate(rows):
        seen = track["valid"] and track["covariance.0"] <= limit
        danger = system.danger(track["state.0"] if seen else None, -track["state.1"], ego["speed_mps"])
        counts[danger] += 1
        side = (command["lambda_human"] * driver["acceleration_mps2"] +
                command["lambda_automation"] * acc["acceleration_mps2"])
        mode = HUMAN if command["lambda_human"] >= 0.5 else AUTOMATION
        if danger == "warning":
            mode = WARNING
        if danger == "braking":
            mode = BRAKING
            side = min(side, -section["deceleration_mps2"])
        differences.expect(command["mode"] == mode, f"step {k}: mode {command['mode']}, peer {mode}")
        differences.expect_near(command["acceleration_mps2"], side, 1e-12, f"step {k}: acceleration")
    return counts


def compare_followers(run, differences):
    section = run.scenario["followers"]["aeb"]
    hardest = run.scenario["follower"]["min_acceleration_mps2"]
    braked = 0
    for car in range(int(run.scenario["followers"]["count"])):
        system = System(section)
        before = 0.0
        for k, (truth, command) in enumerate(zip(run.TRUTH, run.FOLLOWER_COMMAND)):
            ahead = truth["host_speed_mps"] if car == 0 else truth[f"follower_speed_mps.{car - 1}"]
            speed = truth[f"follower_speed_mps.{car}"]
            brakes = system.danger(truth[f"follower_gap_m.{car}"], speed - ahead, speed) == "braking"
            braked += brakes
            applied = command[f"acceleration_mps2.{car}"]
            differences.expect((applied <= -section["deceleration_mps2"]) == brakes,
                               f"step {k}, car {car}: {applied} m/s2, peer {'brakes' if brakes else 'does not'}")
            # After an emergency braking the controller releases the brake gradually.
            differences.expect(brakes or applied >= min(hardest, before) - 1e-9, f"step {k}, car {car}: {applied} m/s2")
            before = applied
    return braked


def main(fogline, scenario):
    differences = Differences()
    for name, fields in CASES.items():
        run = Run(fogline, scenario, SLOW_CAR + fields)
        counts = compare_host(run, differences)
        braked = compare_followers(run, differences)
        print(f"{name}: host {counts}, following cars brake in {braked} steps")
        differences.expect(counts["braking"] > 0, f"{name}: the host never brakes")
        if run.scenario["host_vehicle"]["model"] == "longitudinal":
            # The limit is a friction of 0.15, plus air drag and rolling resistance.
            hardest = min(truth["host_acceleration_mps2"] for truth in run.TRUTH)
            differences.expect(hardest > -(0.15 * 9.80665 + 0.3), f"{name}: {hardest} m/s2 on ice")
    return differences.exit_code()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
