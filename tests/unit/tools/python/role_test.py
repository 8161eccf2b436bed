"""What a role returns becomes messages, and what is wrong with it is named."""

import contextlib
import io
import json
import unittest

import fogline_lab as fl
from fogline_lab.role import RoleFailed, _Factory

SCENARIO = json.dumps({"step_s": 0.1, "driver": {"readiness": 0.7}})
HEADER = fl.header_t(run_id=5, step=3, utime=300_000)


def role_of(kind: type[fl.Role], step):
    """An instance of a class with this step()."""
    made = type("Mine", (kind,), {"step": step})
    return _Factory(made).make(SCENARIO)


def step_of(kind: type[fl.Role], step):
    """The messages of a step whose inputs have HEADER."""
    payloads = [one(header=HEADER).encode() for one in kind.READS]
    results = role_of(kind, step).step(*payloads)
    return [one.decode(result) for one, result in zip(kind.WRITES, results)]


class RoleTest(unittest.TestCase):
    def test_every_role_but_the_recorder_has_a_class(self):
        self.assertEqual([one.ROLE for one in fl.ROLES],
                         ["world", "radar", "lidar", "fusion", "acc", "driver", "arbitrator",
                          "follower"])
        self.assertEqual(fl.Fusion.READS, (fl.ego_t, fl.radar_t, fl.lidar_t))
        self.assertEqual(fl.Driver.ON_DEMAND, fl.arbitration_t)

    def test_a_message_gets_the_header_of_the_step(self):
        for kind in fl.ROLES[1:]:
            (message,) = step_of(kind, lambda self, *inputs: self.WRITES[0]())
            self.assertEqual(message, kind.WRITES[0](header=HEADER))

    def test_a_step_that_changes_its_inputs_changes_no_header_of_an_output(self):
        def step(self, truth):
            truth.header.run_id = 0
            return fl.radar_t()

        self.assertEqual(step_of(fl.Radar, step)[0].header, HEADER)

    def test_the_world_begins_the_step_after_its_inputs(self):
        truth, ego = step_of(fl.World, lambda self, *inputs: (fl.truth_t(), fl.ego_t()))
        self.assertEqual(truth.header, fl.header_t(5, 4, 400_000))
        self.assertEqual(ego.header, truth.header)

    def test_a_number_is_the_acceleration_of_a_driver_or_an_acc(self):
        (command,) = step_of(fl.Driver, lambda self, truth: -1)
        self.assertEqual(command, fl.driver_command_t(header=HEADER, acceleration_mps2=-1.0,
                                                      readiness=0.7, input_sequence=-1))
        (command,) = step_of(fl.Acc, lambda self, ego, track: 0.5)
        self.assertEqual(command, fl.accel_command_t(header=HEADER, acceleration_mps2=0.5))

    def test_what_is_wrong_with_a_result_is_named(self):
        cases = {
            "step 3: Mine.step(): TypeError: returned None in place of driver_command_t":
                (fl.Driver, None),
            "step 3: Mine.step(): TypeError: returned 1.0 in place of radar_t": (fl.Radar, 1),
            "step 3: Mine.step(): ValueError: radar_t.range_m: 'far' is no double":
                (fl.Radar, fl.radar_t(range_m="far")),
        }
        for text, (kind, result) in cases.items():
            with contextlib.redirect_stderr(io.StringIO()):
                with self.assertRaises(RoleFailed) as caught:
                    step_of(kind, lambda self, *inputs: result)
            self.assertEqual(str(caught.exception), text)

    def test_an_exception_is_shown_with_its_place(self):
        stderr = io.StringIO()
        with contextlib.redirect_stderr(stderr), self.assertRaises(RoleFailed) as caught:
            step_of(fl.Driver, lambda self, truth: 1 / 0)
        self.assertEqual(str(caught.exception),
                         "step 3: Mine.step(): ZeroDivisionError: division by zero")
        self.assertIn("role_test.py", stderr.getvalue())

    def test_a_class_that_is_no_role_is_refused(self):
        for wrong in (object, fl.Role, 5):
            with self.assertRaisesRegex(TypeError, "derived from none of the roles"):
                fl.serve(wrong)


if __name__ == "__main__":
    unittest.main()
