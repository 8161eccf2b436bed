// The page of a server that accepts other machines. Only the printed address gives access.
import assert from "node:assert/strict";
import {test} from "node:test";

import {browser, open, recordedRun, scratch, serve, shows, view} from "./window.js";

test("the key of the printed address opens the page, and leaves the address", async (t) => {
  const log = recordedRun(scratch(t));
  const address = await view(t, [log, "--listen", "127.0.0.1"]);
  assert.match(address, /#.*token=/);
  const page = await open(t, await browser(t), address);
  await shows(page, 0);
  assert.ok(!page.url().includes("token"), page.url());
  await page.reload();
  await shows(page, 0);
});

test("a link with the key of the page leads to its step", async (t) => {
  const log = recordedRun(scratch(t));
  const address = await view(t, [log, "--listen", "127.0.0.1"]);
  const page = await open(t, await browser(t), address);
  await shows(page, 0);
  await page.evaluate((link) => { location.href = link; }, `${address}&step=190`);
  await shows(page, 190);
  assert.ok(!page.url().includes("token"), page.url());
});

test("a page without the key says what is missing", async (t) => {
  const log = recordedRun(scratch(t));
  const address = await view(t, [log, "--listen", "127.0.0.1"]);
  const page = await open(t, await browser(t), address.replace(/#.*/, ""));
  await page.waitForFunction(() => document.getElementById("problem").textContent.includes("contains a token"));
  // The page's errors about the refused connection are expected.
  page.trouble = page.trouble.filter((words) => !words.includes("WebSocket"));
});

test("the new address of a server that was started again works in the same tab", async (t) => {
  const log = recordedRun(scratch(t));
  const {server, address} = await serve(t, [log, "--listen", "127.0.0.1"]);
  const page = await open(t, await browser(t), address);
  await shows(page, 0);
  const state = (wanted) => page.waitForFunction(
    (name) => document.getElementById("origin").dataset.state === name, wanted);
  await state("log");
  await page.waitForFunction(() => foglinePage.scene.view);  // this view is loaded last
  server.kill("SIGINT");
  await server.ended;
  await page.waitForFunction(() => document.getElementById("origin-words").textContent === "The program has ended");
  const {host} = new URL(address);
  const again = await view(t, [log, "--listen", host]);
  assert.equal(new URL(again).host, host);
  assert.notEqual(again, address);
  await page.evaluate((pasted) => { location.href = pasted; }, again);
  await state("log");
  assert.ok(!page.url().includes("token"), page.url());
  await page.reload();
  await shows(page, 0);
  // The page's errors from the time without a server are expected.
  page.trouble = page.trouble.filter((words) => !words.includes("WebSocket"));
});
