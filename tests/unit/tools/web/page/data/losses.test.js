import assert from "node:assert/strict";
import {test} from "node:test";

import {lacksOf, lossesOf} from "../../../../../../tools/web/page/data/losses.js";

test("lost packets are counted over all senders", () => {
  assert.deepEqual(lossesOf({senders: [{lost: 0}, {lost: 0}]}), {count: 0, words: "No packet to this viewer was lost."});
  assert.equal(lossesOf({senders: [{lost: 1}]}).words, "One packet to this viewer was lost.");
  assert.deepEqual(lossesOf({senders: [{lost: 1}, {lost: 2}]}),
                   {count: 3, words: "3 packets to this viewer were lost."});
});

test("a network without numbers is not said to lose nothing", () => {
  assert.deepEqual(lossesOf({senders: null, senders_note: "", traffic: {lcm_url: "tcpq://127.0.0.1:7700"}}),
                   {count: 0, words: "Lost packets: not known over tcpq."});
  assert.equal(lossesOf({senders: null, senders_note: "no such option", traffic: {lcm_url: "udpm://x"}}).words,
               "Lost packets: not known: no such option.");
});

test("a message that is not shown, and a client that is refused, have words", () => {
  assert.deepEqual(lacksOf({own_overflow: 0, too_large: 0, refused_scenarios: 0, cut_off: 0, refused: 0}), []);
  assert.deepEqual(
    lacksOf({own_overflow: 1, too_large: 2, too_large_channels: ["CAMERA", "MAP"], refused_scenarios: 3,
             cut_off: 4, refused: 5, wrong_frames: 6}),
    ["this viewer itself missed 1 packet",
     "2 messages are larger than a datagram and not shown (CAMERA, MAP)",
     "3 runs are not shown, because the scenario is not valid", "4 viewers were cut off",
     "5 connections were refused", "6 frames of clients were wrong"]);
  assert.deepEqual(
    lacksOf({own_overflow: 2, too_large: 1, too_large_channels: ["MAP"], refused_scenarios: 1, cut_off: 1, refused: 1}),
    ["this viewer itself missed 2 packets", "1 message is larger than a datagram and not shown (MAP)",
     "1 run is not shown, because the scenario is not valid", "1 viewer was cut off", "1 connection was refused"]);
});
