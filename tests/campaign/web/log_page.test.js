// The page of a recorded run.
import assert from "node:assert/strict";
import {test} from "node:test";

import {browser, goTo, numbersOf, open, recordedRun, scratch, shows, view} from "./window.js";

const text = (page, selector) => page.locator(selector).innerText();

/** The shown values of the chosen fields, by name. */
function shownValues(page) {
  return page.locator("#chosen li").evaluateAll((items) => Object.fromEntries(items.map((item) => [
    item.querySelector(".field-name").textContent, Number(item.querySelector(".value").dataset.value)])));
}

/**
 * Colours in the picture of the road: in the middle of the host, halfway to the preceding car, in
 * the middle of the preceding car, and behind the host.
 */
function roadColours(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("road");
    const {window: {from_m, to_m}, lane} = foglinePage.scene.road;
    const {TRUTH} = foglinePage.frame;
    const length_m = foglinePage.length_m;
    const scale = canvas.width / (to_m - from_m);
    const at = (m) => [...canvas.getContext("2d").getImageData(
      Math.round((m - from_m) * scale), Math.round(lane * devicePixelRatio), 1, 1).data];
    return {host: at(-length_m / 2), gap: at(TRUTH.host_gap_m / 2),
            lead: at(TRUTH.host_gap_m + length_m / 2), behind: at(-length_m - 3)};
  });
}

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

test("three moments of a log show who drives, and the log's own numbers", async (t) => {
  const folder = scratch(t);
  const log = recordedRun(folder);
  const numbers = numbersOf(folder, log);
  const page = await open(t, await browser(t), await view(t, [log]));
  for (const [step, words] of [[50, "The automation drives"], [300, "The human drives"], [650, "The automation drives"]]) {
    await goTo(page, step);
    const [truth, lidar, radar] = ["TRUTH", "LIDAR", "RADAR"].map((channel) => numbers(channel, step));
    assert.equal(await text(page, "#who"), words);
    assert.deepEqual(await shownValues(page), {
      "TRUTH.host_gap_m": truth.host_gap_m, "RADAR.range_m": radar.range_m,
      "LIDAR.range_m": lidar.range_m, "TRUTH.host_speed_mps": truth.host_speed_mps});
    assert.equal(await text(page, "#gap-now"), truth.host_gap_m.toFixed(1));
    assert.equal(await text(page, "#speed-now"), truth.host_speed_mps.toFixed(1));
    const {host, gap, lead, behind} = await roadColours(page);
    assert.ok(distance(host, gap) > 60 && distance(host, behind) > 60, `the host stands at 0 m: ${host} ${gap}`);
    assert.ok(distance(lead, gap) > 8, `the preceding car stands behind the gap: ${lead} ${gap}`);
  }
});

test("the curves have the log's values over the whole time", async (t) => {
  const folder = scratch(t);
  const log = recordedRun(folder, ["/fog/model=modes", "/fog/modes/missing_share=1"]);
  const numbers = numbersOf(folder, log);
  const page = await open(t, await browser(t), await view(t, [log]));
  await page.waitForFunction(() => foglinePage.curves.charts.length === 2 &&
    foglinePage.curves.charts.every(({chart}) => chart.data[1].length === 700));
  const columns = await page.evaluate(() => foglinePage.curves.charts.map(({chart}) => (
    chart.data.map((column) => [column[0], column[270], column[699]]))));
  const [first, deceived, last] = [0, 270, 699].map((step) => ["TRUTH", "RADAR", "LIDAR"].map(
    (channel) => numbers(channel, step)));
  assert.deepEqual(columns[0][0], [0, 27, 69.9]);
  assert.deepEqual(columns[0][1], [first, deceived, last].map(([truth]) => truth.host_gap_m));
  assert.deepEqual(columns[0][3], [first, deceived, last].map(([, , lidar]) => lidar.valid ? lidar.range_m : null));
  const lost = await page.evaluate(() => [...foglinePage.curves.charts[0].chart.data[3]].indexOf(null));
  assert.ok(lost > 0, "the LiDAR has no echo in some steps");
  assert.deepEqual([lost - 1, lost].map((step) => numbers("LIDAR", step).valid), [1, 0]);
  assert.deepEqual(columns[1][1], [first, deceived, last].map(([truth]) => truth.host_speed_mps));
});

test("the numbers of a log of 60,000 steps are those of its steps", async (t) => {
  const folder = scratch(t);
  const log = recordedRun(folder, ["/steps=60000"]);
  const numbers = numbersOf(folder, log);
  const page = await open(t, await browser(t), await view(t, [log]));
  for (const step of [12347, 40001, 59998]) {
    await goTo(page, step);
    const {host_gap_m: gap} = numbers("TRUTH", step);
    for (const [key, channel, field] of [["radar", "RADAR", "range_m"], ["fusion", "TRACK", "state.0"]]) {
      const error = Number((numbers(channel, step)[field] - gap).toFixed(2)) + 0;
      await page.waitForFunction(([id, wanted]) => {
        const words = document.getElementById(id).textContent.replace("\u2212", "-");
        return words !== "" && Math.abs(parseFloat(words) - wanted) < 1e-9;
      }, [`value-${key}`, error]);
    }
  }
  // The curves over the whole time have only the extremes of each span. The value at the cursor
  // must still be the value of the cursor's step.
  await page.locator("#charts .u-over").first().hover({position: {x: 333, y: 40}});
  await page.waitForFunction(() => foglinePage.curves.hover !== null);
  const step = await page.evaluate(() => Math.floor(foglinePage.curves.hover / 0.1 + 1e-6));
  const {host_gap_m: gap} = numbers("TRUTH", step);
  await page.waitForFunction((wanted) => (
    Number(document.querySelector("#chosen .value").dataset.value) === wanted), gap);
});

/**
 * The colours of the preceding car's rear and of one of its lamps in the driver's view, in linear
 * light. `seen` has the colours in the fog, and `clear` the colours without fog.
 */
function leadColours(page) {
  return page.evaluate(() => {
    const {view} = foglinePage.scene;
    const {moment} = foglinePage.curves;
    const gl = view.renderer.getContext();
    const linear = (value) => (value > 10 ? ((value / 255 + 0.055) / 1.055) ** 2.4 : value / 3295);
    const at = (x, y) => {
      const place = view.lead.position.clone();
      place.x += x;
      place.y += y;
      place.z += 0.03;
      place.project(view.camera);
      const pixel = new Uint8Array(4);
      gl.readPixels(Math.round((place.x + 1) / 2 * gl.drawingBufferWidth),
                    Math.round((place.y + 1) / 2 * gl.drawingBufferHeight),
                    1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel.subarray(0, 3)].map(linear);
    };
    const look = () => ({rear: at(0, 0.86), lamp: at(0.68, 0.8)});
    view.draw(moment, 1);
    const seen = look();
    view.scene.fog.near = 0;
    view.renderer.render(view.scene, view.camera);
    const clear = look();
    const {r, g, b} = view.scene.background;
    return {seen, clear, haze: [r, g, b], distance_m: -view.lead.position.z};
  });
}

// The speeds of a leader who brakes with 2 m/s2 after 10 s.
const BRAKES = [{duration_s: 10, speed_mps: 20}, {duration_s: 4, speed_mps: 12}, {duration_s: 60, speed_mps: 12}];

test("the driver's view has the preceding car at its place, its brake lamps, and the fog's contrast", async (t) => {
  const folder = scratch(t);
  const log = recordedRun(folder, ["/lead/profile=breakpoints", `/lead/breakpoints=${JSON.stringify(BRAKES)}`]);
  const numbers = numbersOf(folder, log);
  const page = await open(t, await browser(t), await view(t, [log]));
  await page.waitForFunction(() => foglinePage.scene.view);
  const reds = [];
  for (const step of [50, 300]) {
    await goTo(page, step);
    const {host_gap_m: gap, fog_visibility_m: visibility} = numbers("TRUTH", step);
    const {seen, clear, haze, distance_m} = await leadColours(page);
    assert.ok(Math.abs(distance_m - gap - 2.1) < 1e-3, `the eye is 2.1 m behind the front: ${distance_m} ${gap}`);
    const contrast = distance(seen.rear, haze) / distance(clear.rear, haze);
    const left = 0.05 ** (Math.hypot(distance_m, 0.4) / visibility);  // Koschmieder
    assert.ok(Math.abs(contrast - left) < 0.03, `contrast ${contrast}, by Koschmieder's law ${left}`);
  }
  for (const shines of [true, false]) {
    const step = [...Array(700).keys()].find((i) => (
      shines === (numbers("TRUTH", i).preceding_acceleration_mps2 < -0.7)));
    await goTo(page, step);
    const [red, green] = (await leadColours(page)).clear.lamp;
    reds.push(red - green);
  }
  assert.ok(reds[0] > 0.7 && reds[1] < 0.3, `red of the lamps, braking and not: ${reds}`);
});

test("a request to take over counts down, and the page says who drives", async (t) => {
  const log = recordedRun(scratch(t), ["/arbitrator/take_over/mode=requested",
                                       "/arbitrator/take_over/absent_probability=1"]);
  const page = await open(t, await browser(t), await view(t, [log]));
  await goTo(page, 200);
  assert.equal(await page.locator("#request").isVisible(), false);
  await goTo(page, 310);
  assert.equal(await text(page, "#who"), "The automation drives and urgently asks the human to take over");
  assert.equal(await text(page, "#request-left"), "6.0\u00a0s");
  await goTo(page, 400);
  assert.equal(await page.locator("#request").isVisible(), false);
  await page.waitForFunction(() => document.getElementById("announcement").textContent ===
    "Minimal risk manoeuvre: comfortable stop.");
  assert.match(await text(page, "#reason"),
    /^Neither the automation nor the human goes on driving\. The human has not taken over in time\. The manoeuvre/);
});

test("a link opens its moment, and an event of the list is a jump away", async (t) => {
  const log = recordedRun(scratch(t));
  const address = await view(t, [log]);
  const page = await open(t, await browser(t), `${address.replace(/#.*/, "")}#step=123`);
  await shows(page, 123);
  await page.evaluate(() => { location.hash = "#step=321"; });
  await shows(page, 321);
  const events = page.locator("#events button");
  const step = await events.last().getAttribute("data-step");
  await events.last().click();
  await shows(page, Number(step));
  await page.waitForFunction((wanted) => location.hash === `#step=${wanted}`, step);
});

test("everything works with the keyboard alone", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]));
  await shows(page, 0);
  const press = async (key, step) => {
    await page.keyboard.press(key);
    await shows(page, step);
  };
  await press("ArrowRight", 1);
  await press("Shift+ArrowRight", 11);
  await press("ArrowLeft", 10);
  await press("End", 699);
  await press("Home", 0);
  await page.keyboard.press(".");
  await page.waitForFunction(() => Number(document.body.dataset.step) > 100);
  await page.keyboard.press("+");
  await page.waitForFunction(() => document.getElementById("speed").value === "2");  // at the next frame
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number(document.body.dataset.step) > 160);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => document.getElementById("play").ariaLabel === "Play");

  await page.keyboard.press("?");
  assert.ok(await page.locator("#help").isVisible());
  await page.keyboard.press("?");
  assert.equal(await page.locator("#help").isVisible(), false);

  await page.keyboard.press("/");
  await page.keyboard.type("lambda human");
  await page.keyboard.press("Enter");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Escape");
  assert.ok((await page.locator("#chosen").innerText()).includes("HOST_COMMAND.lambda_human"));
});

test("curves: type a field, zoom by a drag, back by a double click, choose a moment by a click", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]));
  await page.waitForFunction(() => foglinePage.curves.charts[0]?.chart.data[0]?.length === 700);
  const span = () => page.evaluate(() => {
    const {min, max} = foglinePage.curves.charts[0].chart.scales.x;
    return [min, max];
  });
  const plot = page.locator("#charts .u-over").first();
  const whole = await span();
  await plot.hover({position: {x: 100, y: 40}});  // hover() waits until the chart does not move
  await page.mouse.down();
  await plot.hover({position: {x: 300, y: 40}});
  await page.mouse.up();
  await page.waitForFunction(([, last]) => foglinePage.curves.charts[0].chart.scales.x.max < last - 1, whole);
  const zoomed = await span();
  assert.ok(zoomed[0] > whole[0] + 1 && zoomed[1] < whole[1] - 1, String(zoomed));
  await plot.dblclick({position: {x: 50, y: 40}});
  await page.waitForFunction(([, last]) => foglinePage.curves.charts[0].chart.scales.x.max === last, whole);
  assert.deepEqual(await span(), whole);

  const {width} = await plot.boundingBox();
  await plot.click({position: {x: width / 2, y: 40}});
  await page.waitForFunction(() => Math.abs(Number(document.body.dataset.step) - 350) < 3);
  await page.locator("#field-search").fill("doc");
  await page.locator("#field-list li", {hasText: "HOST_COMMAND.doc"}).click();
  await page.locator("#chosen button[aria-label='Remove RADAR.range_m']").click();
  const names = await page.locator("#chosen .field-name").allInnerTexts();
  assert.deepEqual(names, ["TRUTH.host_gap_m", "LIDAR.range_m", "TRUTH.host_speed_mps", "HOST_COMMAND.doc"]);
});

test("Why shows nothing that is later than the shown moment", async (t) => {
  // 0.3 s is a whole number of microseconds, but not every multiple of 0.3 is exact: 3 * 0.3 < 0.9.
  // Also with such rounding, the charts must end at the shown step.
  for (const step_s of [0.1, 0.3]) {
    const folder = scratch(t);
    const log = recordedRun(folder, [`/step_s=${step_s}`]);
    const numbers = numbersOf(folder, log);
    const time = (step) => numbers("TRUTH", step)["header.utime"] / 1e6;
    const steps = [...Array(400).keys()];
    const fog = steps.find((step) => numbers("TRUTH", step).fog_present === 1);
    const human = steps.find((step) => numbers("HOST_COMMAND", step).mode === 1);
    const page = await open(t, await browser(t), await view(t, [log]));
    for (const step of [3, fog - 1, fog, fog + 3, human - 1, human + 3]) {
      await goTo(page, step);
      await page.waitForFunction((now) => foglinePage.why.charts.every(({data: [times]}) => times.at(-1) === now), time(step));
      const {last, sides, fogs} = await page.evaluate(() => {
        const {why} = foglinePage;
        return {last: why.charts[0].scales.x.max, sides: why.sideSpans(), fogs: why.fogSpans()};
      });
      assert.equal(last, Math.max(20, time(step)));
      const drives = sides.at(-1);
      assert.deepEqual([drives.value, drives.to], [step < human ? "automation" : "human", time(step)]);
      if (step >= human) assert.equal(drives.from, time(human));
      assert.deepEqual(fogs, step < fog ? [] : [{from: time(fog), to: time(step), value: 1}]);
    }
  }
});

test("a mode has its name, and a ninth curve is refused in words", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]));
  await goTo(page, 300);
  const add = async (name) => {
    await page.locator("#field-search").fill(name);
    await page.locator("#field-list li", {hasText: name}).first().click();
  };
  const names = ["HOST_COMMAND.mode", "HOST_COMMAND.doc", "HOST_COMMAND.threshold", "HOST_COMMAND.lambda_human"];
  for (const name of names) await add(name);
  await page.waitForFunction(() => (
    [...document.querySelectorAll("#chosen li")].some((item) => /HOST_COMMAND\.mode.*1\sHUMAN/.test(item.textContent))));
  await add("TRUTH.host_acceleration_mps2");
  await page.waitForFunction(() => document.getElementById("note").textContent ===
    "At most 8 curves are shown. Remove one before you add TRUTH.host_acceleration_mps2.");
  assert.equal(await page.locator("#chosen li").count(), 8);
});

test("until the messages of a step have come, all parts show the step before", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]));
  await goTo(page, 300);
  const meanwhile = await page.evaluate(async () => {
    const {store, why, curves} = foglinePage;
    store.frame = () => null;  // the requested messages never come
    foglinePage.goTo(50);
    for (let i = 0; i < 3; ++i) await new Promise(requestAnimationFrame);
    delete store.frame;
    return {wanted: foglinePage.step, shown: document.body.dataset.step, why_s: why.moment.time,
            curves_s: curves.moment.time, slider: document.getElementById("time").value};
  });
  assert.deepEqual(meanwhile, {wanted: 50, shown: "300", why_s: 30, curves_s: 30, slider: "50"});
  await shows(page, 50);
  assert.equal(await page.evaluate(() => foglinePage.curves.moment.time), 5);
});

test("a change of the colour scheme redraws the charts in its colours", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]), {colorScheme: "light"});
  await goTo(page, 300);
  const ink = () => page.evaluate(() => foglinePage.why.charts[0].series[1].stroke());
  const light = await ink();
  await page.emulateMedia({colorScheme: "dark"});
  await page.waitForFunction((before) => foglinePage.why.charts[0].series[1].stroke() !== before, light);
  assert.equal(await text(page, "#who"), "The human drives");
});

test("cars do not glide between steps for readers who want no motion", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]), {reducedMotion: "reduce"});
  await shows(page, 0);
  await page.keyboard.press("Space");
  const glides = await page.evaluate(async () => {
    const found = [];
    for (let i = 0; i < 30; ++i) {
      await new Promise(requestAnimationFrame);
      found.push(foglinePage.aheadOf(foglinePage.step));
    }
    return found;
  });
  assert.deepEqual(new Set(glides), new Set([0]));
});

test("a page that connects again keeps its step and the fog, however late the log is described", async (t) => {
  const log = recordedRun(scratch(t));
  const page = await open(t, await browser(t), await view(t, [log]));
  await goTo(page, 190);
  await page.evaluate(() => {
    const {receive} = foglinePage;
    const held = [];
    foglinePage.receive = (object) => {
      if (object.op === "hello") setTimeout(() => {
        for (const one of held) receive.call(foglinePage, one);
        foglinePage.receive = receive;
        window.isConnectedAgain = true;
      }, 500);
      if (object.op === "hello") receive.call(foglinePage, object);
      else held.push(object);
    };
    foglinePage.wire.socket.close();
  });
  await page.waitForFunction(() => window.isConnectedAgain);
  await shows(page, 190);
  await page.waitForFunction(() => foglinePage.why.fog?.length > 0);
});
