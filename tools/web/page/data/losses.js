// Texts about the lost messages of a `health` frame.

/** {count, words}: the packets that were lost, 0 if that is not known. */
export function lossesOf({senders, senders_note: note, traffic}, number = String) {
  if (!senders) {
    const transport = traffic?.lcm_url?.split(":")[0];
    const why = note ? `: ${note}` : transport ? ` over ${transport}` : "";
    return {count: 0, words: `Lost packets: not known${why}.`};
  }
  const count = senders.reduce((sum, {lost}) => sum + lost, 0);
  const words = count === 0 ? "No packet was lost."
    : count === 1 ? "One packet was lost on the network."
    : `${number(count)} packets were lost on the network.`;
  return {count, words};
}

/** Texts about messages that the viewer does not show, and about clients that it has refused. */
export function lacksOf(health, number = String) {
  const {own_overflow: missed, too_large: large, too_large_channels: channels = [],
         refused_scenarios: scenarios, cut_off: cutOff, refused} = health;
  return [
    missed && `this viewer itself missed ${number(missed)} packets`,
    large && `${number(large)} messages are larger than a datagram and not shown ` +
      `(${channels.join(", ")})`,
    scenarios && `${number(scenarios)} runs without a valid scenario are not shown`,
    cutOff && `${number(cutOff)} viewers were cut off`,
    refused && `${number(refused)} connections were refused`,
  ].filter(Boolean);
}
