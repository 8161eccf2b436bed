import assert from "node:assert/strict";
import {test} from "node:test";

import {Catalogue} from "../../../../../../tools/web/page/data/catalogue.js";
import {LiveStore} from "../../../../../../tools/web/page/data/live_store.js";
import {describedTypes, realLog} from "../real_log.js";

test("the first step that is left of a long run has its messages", () => {
  // The length of a step divides the 600 s that a page keeps.
  const {events} = realLog("/step_s=0.5", "/steps=2500");
  const channels = ["TRUTH", "RADAR"].map((name, id) => ({id, name, type: `${name.toLowerCase()}_t`}));
  const store = new LiveStore(new Catalogue({types: describedTypes(), channels}));
  let seen = 0;
  for (const {channel: name, bytes} of events) {
    const channel = channels.find((one) => one.name === name);
    if (!channel) continue;
    store.add({channel: channel.id, arrived_ms: 0, bytes});
    const frame = store.frame(store.firstStep);
    assert.equal(frame.TRUTH?.header.step, store.firstStep);
    seen = Math.max(seen, store.firstStep);
  }
  assert.ok(seen > 0, "the run was not so long that the page forgot its begin");
});
