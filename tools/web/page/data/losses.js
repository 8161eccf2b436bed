// Texts about the lost messages of a `health` frame.

/** Returns {count, words}: the number of lost messages, 0 if it is unknown, and a text about it. */
export function lossesOf({senders, senders_note: note, traffic}, number = String) {
  if (!senders) {
    const transport = traffic?.lcm_url?.split(":")[0];
    const why = note ? `: ${note}` : transport ? ` over ${transport}` : "";
    return {count: 0, words: `Lost packets: not known${why}.`};
  }
  const count = senders.reduce((sum, {lost}) => sum + lost, 0);
  const words = count === 0 ? "No packet to this viewer was lost."
    : count === 1 ? "One packet to this viewer was lost."
    : `${number(count)} packets to this viewer were lost.`;
  return {count, words};
}

/**
 * Texts about messages that the viewer does not show, and about clients that the server has
 * refused.
 */
export function lacksOf(health, number = String) {
  const {own_overflow: missed, too_large: large, too_large_channels: channels = [],
         refused_scenarios: scenarios, cut_off: cutOff, refused,
         wrong_frames: wrong} = health;
  const are = (n, thing, rest) => n && `${number(n)} ${thing}${n === 1 ? " is" : "s are"} ${rest}`;
  const were = (n, thing, rest) => n && `${number(n)} ${thing}${n === 1 ? " was" : "s were"} ${rest}`;
  return [
    missed && `this viewer itself missed ${number(missed)} packet${missed === 1 ? "" : "s"}`,
    are(large, "message", `larger than a datagram and not shown (${channels.join(", ")})`),
    are(scenarios, "run", "not shown, because the scenario is not valid"),
    were(cutOff, "viewer", "cut off"),
    were(refused, "connection", "refused"),
    wrong && `${number(wrong)} frame${wrong === 1 ? "" : "s"} of clients ${wrong === 1 ? "was" : "were"} wrong`,
  ].filter(Boolean);
}
