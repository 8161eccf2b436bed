import math

import fogline_lab as fl


class MyDriver(fl.Driver):
    def step(self, truth):
        p = self.scenario["driver"]
        if truth.host_gap_m <= 0:
            return -p["max_deceleration_mps2"]
        v = max(truth.host_speed_mps, 0.0)
        brisk = 2 * math.sqrt(p["max_acceleration_mps2"] * p["comfortable_deceleration_mps2"])
        dynamic_gap_m = v * p["headway_s"] + v * (v - truth.preceding_speed_mps) / brisk
        gap_ratio = (p["standstill_m"] + max(0.0, dynamic_gap_m)) / truth.host_gap_m
        speed_ratio = v / p["desired_speed_mps"]
        freedom = 1 - speed_ratio ** p["exponent"] - gap_ratio * gap_ratio
        return max(p["max_acceleration_mps2"] * freedom, -p["max_deceleration_mps2"])


fl.serve(MyDriver)
