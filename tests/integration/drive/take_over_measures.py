#!/usr/bin/env python3
"""The measures of each request to take over, worked out from the raw messages of a log.

    take_over_measures.py LOG PEDAL

PEDAL is /person/take_over_pedal of the run. The script uses nothing of Fogline: it reads LCM's log
format and the encoding of the messages itself, and applies the definitions of
services/metrics/README.md. It prints a JSON list with one object for each request.
"""
import json
import struct
import sys

AUTOMATION, HUMAN, MINIMAL_RISK, REQUEST, HANDOVER, RECOVERING, MRM_DONE = 0, 1, 2, 3, 5, 6, 9


class Cursor:
    """Reads numbers of LCM's encoding: big-endian, after a fingerprint of 8 bytes."""

    def __init__(self, data):
        self.data, self.place = data, 8

    def take(self, kinds):
        values = struct.unpack_from(">" + kinds, self.data, self.place)
        self.place += struct.calcsize(">" + kinds)
        return values

    def header(self):
        run_id, step, utime = self.take("qqq")
        return {"run_id": run_id, "step": step, "t": utime / 1e6}


def truth(data):
    c = Cursor(data)
    message = c.header()
    (_, lead_mps, _, _, speed, acceleration, gap, followers) = c.take("dddddddi")
    c.take(f"{4 * followers}d")
    (fog,) = c.take("b")
    return message | {"lead": lead_mps, "v": speed, "a": acceleration, "gap": gap, "fog": fog != 0}


def host_command(data):
    c = Cursor(data)
    message = c.header()
    acceleration, _, human, _, _, _, mode = c.take("ddddddb")
    return message | {"a": acceleration, "human": human, "mode": mode}


def driver_command(data):
    c = Cursor(data)
    message = c.header()
    acceleration, _, _, _, instance, _ = c.take("ddbbqq")
    return message | {"a": acceleration, "instance": instance}


def driver_input(data):
    c = Cursor(data)
    message = c.header()
    instance, _, _, _, _, length = c.take("qqqqbi")
    c.place += length
    present, throttle, brake, axes = c.take("bddi")
    c.place += 8 * axes
    (buttons,) = c.take("i")
    return message | {"instance": instance, "present": present != 0, "throttle": throttle,
                      "brake": brake, "button": buttons & 1 != 0}


DECODERS = {"TRUTH": truth, "HOST_COMMAND": host_command, "DRIVER_COMMAND": driver_command,
            "DRIVER_INPUT": driver_input}


def read_log(path):
    """The decoded messages of a log by channel, in the order of their arrival."""
    messages = {name: [] for name in DECODERS}
    with open(path, "rb") as log:
        while head := log.read(28):
            sync, _, _, channel_length, data_length = struct.unpack(">IqqII", head)
            assert sync == 0xEDA1DA01
            channel = log.read(channel_length).decode()
            data = log.read(data_length)
            if channel in DECODERS:
                messages[channel].append(DECODERS[channel](data))
    return messages


def first(values):
    return next(iter(values), None)


def least(values):
    return min(values, default=None)


def jerk_1s(truths, k):
    """|a(t) - a(t - 1 s)| / 1 s at truths[k]; None in the first second."""
    since = truths[k]["t"] - 1
    known = [one for one in truths[: k + 1] if one["step"] > 0]  # step 0 has no acceleration
    if not known or known[0]["t"] > since + 1e-9:
        return None
    before = next(one for one in known if one["t"] >= since - 1e-9)
    return abs(truths[k]["a"] - before["a"])


def end_of(request, truths, commands):
    """The first step after the request in which one of these conditions holds: the driver has
    recovered, the automation drives again, or the car stands after a minimal risk manoeuvre.

    Without such a step it is the last step of the run."""
    for one in truths:
        command = commands.get(one["step"])
        if one["step"] <= request or command is None:
            continue
        if command["mode"] in (AUTOMATION, HUMAN, MRM_DONE):
            return one["step"]
        if command["mode"] == MINIMAL_RISK and one["v"] < 0.01:
            return one["step"]
    return truths[-1]["step"]


def movement_times(inputs, seats, asked_s, end_s, pedal):
    """The times of the first movement and of pedal-on, from the inputs of the seats that drove."""
    moved = on = None
    for seat in seats:
        rest = {"throttle": 0, "brake": 0, "button": False}
        for one in (one for one in inputs if one["instance"] == seat):
            if one["t"] <= asked_s + 1e-9:
                rest = one if one["present"] else {"throttle": 0, "brake": 0, "button": False}
                continue
            if not one["present"] or one["t"] > end_s + 1e-9:
                continue
            since = one["t"] - asked_s
            differs = max(abs(one[name] - rest[name]) for name in ("throttle", "brake")) >= 0.01
            if moved is None and (differs or (one["button"] and not rest["button"])):
                moved = since
            if on is None and max(one["throttle"], one["brake"]) >= pedal:
                on = since
    return moved, on


def measures(request, messages, pedal):
    truths = messages["TRUTH"]
    commands = {one["step"]: one for one in messages["HOST_COMMAND"]}
    offers = {one["step"]: one["a"] for one in messages["DRIVER_COMMAND"]}
    seats = {one["instance"] for one in messages["DRIVER_COMMAND"]} - {0}
    end = end_of(request, truths, commands)
    inside = [k for k, one in enumerate(truths) if request <= one["step"] <= end]
    after = inside[1:]
    begin, last = truths[inside[0]], truths[inside[-1]]
    asked_s = begin["t"]
    answers = [commands[truths[k]["step"]] for k in inside if truths[k]["step"] in commands]

    def since(command):
        return None if command is None else command["t"] - asked_s

    taken = first(one for one in answers if one["mode"] in (HUMAN, RECOVERING))
    effective = None
    if taken is not None:
        before = [one["a"] for step, one in sorted(commands.items()) if step < taken["step"]][-1]
        effective = first(
            one for one in answers if one["mode"] in (HUMAN, RECOVERING)
            and abs(one["human"] * (offers.get(one["step"], before) - before)) >= 0.01)

    # `fog` is the speed in the first step of a fog. If there is fog at the request, that fog
    # counts. Otherwise the next fog counts.
    fog = None
    for k in range(inside[-1] + 1):
        if truths[k]["fog"] and (k == 0 or not truths[k - 1]["fog"]):
            if k <= inside[0] or fog is None:
                fog = truths[k]["v"]
        if not truths[k]["fog"] and k <= inside[0]:
            fog = None

    drove = {"automation": 0.0, "driver": 0.0, "manoeuvre": 0.0}
    mode = REQUEST
    for k in after:
        side = ("driver" if mode in (HUMAN, RECOVERING)
                else "manoeuvre" if mode == MINIMAL_RISK or 7 <= mode <= 10 else "automation")
        drove[side] += truths[k]["t"] - truths[k - 1]["t"]
        mode = commands.get(truths[k]["step"], {"mode": mode})["mode"]

    moved, on = movement_times(messages["DRIVER_INPUT"], seats, asked_s, last["t"], pedal)
    slowing = [-truths[k]["a"] for k in after if truths[k]["a"] < 0]
    closing = [one for one in (truths[k] for k in inside) if one["v"] > one["lead"]]
    return {
        "requested_s": asked_s,
        "judged_s": last["t"] - asked_s,
        "first_movement_time_s": moved,
        "pedal_on_time_s": on,
        "reaction_time_s": since(first(one for one in answers if one["mode"] == HANDOVER)),
        "take_over_time_s": since(first(one for one in answers if one["human"] >= 0.5)),
        "effective_input_time_s": since(effective),
        "speed_at_request_mps": begin["v"],
        "speed_at_fog_mps": fog,
        "max_deceleration_mps2": max(slowing, default=0.0),
        "mean_deceleration_mps2": sum(slowing) / len(slowing) if slowing else None,
        "max_abs_jerk_1s_mps3": max((j for k in after if (j := jerk_1s(truths, k)) is not None),
                                    default=None),
        "min_ttc_s": least(one["gap"] / (one["v"] - one["lead"]) for one in closing),
        "min_time_gap_s": least(truths[k]["gap"] / truths[k]["v"] for k in inside
                                if truths[k]["v"] > 0.01),
        "automation_drove_s": drove["automation"],
        "driver_drove_s": drove["driver"],
        "manoeuvre_drove_s": drove["manoeuvre"],
    }


def main():
    messages = read_log(sys.argv[1])
    pedal = float(sys.argv[2])
    commands = messages["HOST_COMMAND"]
    requests = [now["step"] for before, now in zip([{"mode": AUTOMATION}] + commands, commands)
                if now["mode"] == REQUEST and before["mode"] == AUTOMATION]
    print(json.dumps([measures(step, messages, pedal) for step in requests]))


if __name__ == "__main__":
    main()
