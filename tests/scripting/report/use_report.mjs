// Every control of the page of one mesh.
import { pixels_of, require_equal, require_near, require_no_complaints, require_that, state_of } from "./browser.mjs";

const k_most_places = Number(process.env.STERNA_MOST_PLACES ?? 30);
const k_least_share = 0.004; // of the picture that must be drawn: a slender body from the front is small
const k_pixel = 1.5; // of the picture
const k_f32 = 1e-6; // relative: positions on the way through the graphics card

async function require_picture(page, what, least = k_least_share) {
  const { share, colours } = await pixels_of(page);
  require_that(share >= least && colours > 3, `${what}: the picture is blank (${(100 * share).toFixed(2)} % drawn, ${colours} colours)`);
}

async function settled(page) {
  await page.waitForFunction(() => !window.sterna.state().camera?.is_flying, null, { timeout: 20000 });
  return state_of(page);
}

async function tab(page, name) {
  await page.click(`#tab_${name}`);
  const shown = await page.evaluate((n) => !document.getElementById(`body_${n}`).hidden && document.getElementById(`body_${n}`).innerText.trim().length, name);
  require_that(shown > 0, `the tab ${name} is empty`);
}

/** Everything of the page. Returns what was used, in words. */
export async function use_report({ page, open, file, report, shot, keep }) {
  const start = await state_of(page);
  require_that(start.has_view, `no picture: ${start.message}`);
  require_equal(start.message, "", "sentence over the picture");
  await require_picture(page, "at the start");
  await shot("start");
  require_equal(await page.textContent("#verdict").then((t) => t.replace(/^mesh/, "")), report.verdict, "verdict");

  for (const element of await page.$$(".tab")) await tab(page, (await element.getAttribute("id")).slice(4));
  await use_views(page, shot, keep);
  await use_patches(page, report);
  await use_colours(page, report, shot);
  await use_pointer(page, report);
  await use_cuts(page, report, shot);
  const n_places = await use_places(page, report, shot);
  await use_changes(page, report, shot);
  await use_gates(page, report);
  await use_histograms(page, report, shot);
  await use_run(page, report, shot);
  await use_link(page, open, file, report, shot);
  require_no_complaints(page, "the page complained");
  return `${report.patches.length} patches, ${report.surface.fields.length} fields, ${report.cuts.length} cuts, ${n_places} of ${report.places.length} places, ${report.histograms.length} histograms`;
}

async function use_views(page, shot, keep) {
  const seen = new Set();
  for (const name of ["front", "back", "side", "top", "bottom", "iso"]) {
    await page.click(`#view_${name}`);
    const state = await settled(page);
    require_equal(state.values.view, name, "named view");
    seen.add(state.camera.orientation.map((q) => q.toFixed(3)).join());
    await require_picture(page, `view ${name}`);
    if (name === "top") await shot("view_top");
  }
  require_equal(seen.size, 6, "different views");
  await page.click("#view_fit");
  for (const toggle of ["toggle_edges", "toggle_markers"]) {
    if (!(await page.$(`#${toggle}`))) continue;
    for (const _ of [0, 1]) {
      const before = await page.getAttribute(`#${toggle}`, "aria-pressed");
      await page.click(`#${toggle}`);
      require_that((await page.getAttribute(`#${toggle}`, "aria-pressed")) !== before, `${toggle} does not toggle`);
    }
  }
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save_picture")]);
  require_that(download.suggestedFilename().endsWith(".png"), "the saved picture is no PNG");
  await Promise.race([keep(download, "saved"), page.waitForTimeout(30000).then(() => require_that(false, "the picture was not saved within 30 s"))]);
  const narrow = (await pixels_of(page)).width;
  await page.click("#toggle_panel");
  await page.waitForFunction((width) => window.sterna.pixels().width > width, narrow); // the view takes the panel's room
  await page.click("#toggle_panel");
  await page.waitForFunction((width) => window.sterna.pixels().width === width, narrow);
}

async function use_patches(page, report) {
  await tab(page, "surface");
  const count = (list) => list.reduce((sum, k) => sum + report.patches[k].triangles, 0);
  const is_whole = report.surface.shown === report.patches.reduce((sum, p) => sum + p.triangles, 0);
  const all = report.patches.map((_, k) => k), walls = all.filter((k) => report.patches[k].kind === "wall");
  const drawn = async (list, what) => {
    const state = await state_of(page);
    require_equal([...state.values.patches].sort((a, b) => a - b), list, `patches shown, ${what}`);
    // A thinned picture has fewer triangles than its patches.
    if (is_whole) require_equal(state.drawn.surface, count(list), `triangles drawn, ${what}`);
  };
  for (const k of all) {
    const was = await page.isChecked(`#patch_${k}`);
    await page.click(`#patch_${k}`);
    require_equal(await page.isChecked(`#patch_${k}`), !was, `box of patch ${k}`);
    await page.click(`#patch_${k}`);
  }
  await page.click("#patches_none");
  await drawn([], "none");
  await page.click("#patches_all");
  await drawn(all, "all");
  for (const [k, element] of (await page.$$("#body_surface tbody button")).entries()) {
    await element.click();
    await drawn([k], `only ${k}`);
  }
  await page.click("#patches_walls");
  await drawn(walls, "walls");
  if (!walls.length) await page.click("#patches_all");
}

async function use_colours(page, report, shot) {
  await page.click("#patches_all"); // the bar's range is that of the patches that are shown
  for (const field of report.surface.fields) {
    await page.selectOption("#color", field.name);
    const state = await state_of(page);
    if (typeof field.min === "number" && field.max > field.min && !(field.is_log && field.min <= 0)) {
      const [low, high, is_log] = state.color_bar.surface;
      require_near([low, high], [field.min, field.max], 1e-6 * Math.abs(field.max), `colour bar of ${field.name}`);
      require_equal(is_log, field.is_log && field.min > 0, `logarithmic bar of ${field.name}`);
      const middle = field.is_log && low > 0 ? Math.sqrt(low * high) : (low + high) / 2;
      await page.fill("#range_low", String(middle));
      await page.keyboard.press("Enter");
      require_near((await state_of(page)).color_bar.surface.slice(0, 1), [middle], 1e-4 * Math.abs(high), `range of ${field.name}`);
      await page.click("#range_most");
      const [from, to] = (await state_of(page)).color_bar.surface;
      require_that(low <= from && from < to && to <= high, `range of most of ${field.name}: ${from} to ${to} of ${low} to ${high}`);
      await page.click("#range_whole");
      require_near((await state_of(page)).color_bar.surface.slice(0, 1), [low], 1e-6 * Math.abs(high), `whole range of ${field.name}`);
    }
    require_that((await page.textContent(".legends")).includes(field.title), `no bar of ${field.name}`);
    if (Object.values(field.limits).some((limit) => typeof limit === "number")) {
      await page.click("#by_limits");
      require_that((await page.textContent(".legends")).includes("by its limits"), `${field.name} is not coloured by its limits`);
      await page.click("#by_limits");
    }
    await require_picture(page, `coloured by ${field.name}`);
    await shot(`color_${field.name}`);
  }
  if (report.patches.some((patch) => patch.kind === "wall")) await page.click("#patches_walls");
  if (report.surface.fields.length) {
    await page.selectOption("#toolbar_color", "patch");
    require_equal(await page.inputValue("#color"), "patch", "colour of both lists");
    await page.selectOption("#color", report.surface.fields[0].name);
    for (const map of ["magma", "cividis", "viridis"]) await page.selectOption("#map", map);
  }
}

async function use_pointer(page, report) {
  await page.click("#view_iso");
  await settled(page);
  const box = await page.locator("canvas.view_canvas").boundingBox();
  // A ray over the picture finds the body somewhere; what is found must lie under the pointer.
  let found = null;
  for (let k = 1; k < 20 && !found; ++k) {
    const x = box.x + (box.width * (0.3 + 0.4 * ((k * 7) % 20))) / 20 + box.width * 0.2, y = box.y + (box.height * (k + 0.5)) / 20;
    await page.mouse.move(x, y);
    await page.waitForTimeout(250);
    if ((await state_of(page)).picked) found = { x: x - box.x, y: y - box.y };
  }
  require_that(found, "the pointer finds nothing on the body");
  await page.mouse.move(box.x + found.x, box.y + found.y);
  const is_under = ({ x, y, near }) => {
    const at = window.sterna.state().picked?.on_screen;
    return at && Math.hypot(at[0] - x, at[1] - y) < near;
  };
  await page.waitForFunction(is_under, { ...found, near: k_pixel }, { timeout: 10000 }).catch(() => require_that(false, `what was picked does not lie under the pointer at ${JSON.stringify(found)}`));
  const { picked } = await state_of(page);
  await page.mouse.click(box.x + found.x, box.y + found.y);
  require_that((await page.textContent(".info")).includes(report.patches[picked.patch].name), "the text under the pointer lacks the patch");

  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const drag = async (dx, dy, key) => {
    if (key) await page.keyboard.down(key);
    await page.mouse.move(...middle);
    await page.mouse.down();
    for (let k = 1; k <= 4; ++k) await page.mouse.move(middle[0] + (dx * k) / 4, middle[1] + (dy * k) / 4);
    await page.mouse.up();
    if (key) await page.keyboard.up(key);
    return state_of(page);
  };
  const before = await state_of(page);
  // Eight half pictures upwards: more than a whole turn, over both poles.
  const turned = new Set();
  for (let k = 0; k < 8; ++k) turned.add((await drag(0, -box.height * 0.4)).camera.orientation.map((q) => q.toFixed(3)).join());
  require_equal(turned.size, 8, "orientations of a turn over the poles");
  require_that(JSON.stringify((await drag(100, 0)).camera.orientation) !== JSON.stringify(before.camera.orientation), "dragging does not turn");
  const moved = await drag(60, 30, "Shift");
  require_that(JSON.stringify(moved.camera.target) !== JSON.stringify(before.camera.target), "Shift and dragging does not move");
  await drag(60, 0, "Alt");
  await page.mouse.move(...middle);
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(100);
  require_that((await state_of(page)).camera.distance < moved.camera.distance, "the wheel does not zoom");
  await page.focus("canvas.view_canvas");
  for (const key of ["ArrowLeft", "ArrowUp", "Shift+ArrowRight", "+", "-"]) await page.keyboard.press(key);
  await page.click("#view_fit"); // what was moved by hand may have left the picture; the orientation stays
  await settled(page);
  await require_picture(page, "after turning by hand");
  await page.mouse.dblclick(...middle);
  await page.click("#view_iso");
  await settled(page);
}

async function use_cuts(page, report, shot) {
  if (!report.cuts.length) return require_that(!(await page.$("#tab_cuts")), "a tab of cuts without cuts");
  await tab(page, "cuts");
  for (const [k, cut] of report.cuts.entries()) {
    await page.click(`#cut_${k}`);
    const state = await settled(page);
    require_near(state.camera.target, cut.focus.center, k_f32 * report.length, `camera's target at cut ${k}`);
    const n_polygons = cut.first.n - 1;
    require_that(n_polygons <= 0 || state.drawn.cut >= n_polygons, `cut ${k} draws ${state.drawn.cut} triangles of ${n_polygons} polygons`);
    require_that(state.clip.some((x, c) => c < 3 && x !== 0), `the surface is not cut off at cut ${k}`);
    if (n_polygons > 0) await require_picture(page, `cut ${k}`);
    for (const field of cut.fields) {
      await page.selectOption("#cut_color", field.name);
      require_that((await state_of(page)).color_bar.cut, `no bar of ${field.name} at cut ${k}`);
    }
    await shot(`cut_${k}`);
    await page.selectOption("#cut_color", "kind");
    await page.selectOption("#around", "hide");
    require_equal((await state_of(page)).drawn.surface, 0, `triangles of a hidden surface, cut ${k}`);
    await page.selectOption("#around", "show");
    require_equal((await state_of(page)).clip.slice(0, 3), [0, 0, 0], "plane that cuts off a whole surface");
    await page.selectOption("#around", "clip");
    await page.click("#cut_edges");
    await page.click("#cut_edges");
    await page.click("#cut_fly");
    await settled(page);
  }
  await shot("cut_last");
  await page.click("#cut_none");
  require_equal((await state_of(page)).drawn.cut, 0, "triangles of no cut");
}

async function use_places(page, report, shot) {
  if (!report.places.length) return 0;
  await tab(page, "places");
  await page.click("#places_markers");
  require_equal((await state_of(page)).drawn.markers, report.places.length, "markers");
  await page.click("#view_iso");
  const { marker_at } = (await settled(page)).drawn;
  if (marker_at) {
    const box = await page.locator("canvas.view_canvas").boundingBox();
    await page.mouse.click(box.x + marker_at[0], box.y + marker_at[1]);
    require_that((await state_of(page)).values.place >= 0, "a click on a marker chooses no place");
  }
  const step = Math.max(1, Math.ceil(report.places.length / k_most_places));
  let n_used = 0;
  for (let k = 0; k < report.places.length; k += step, ++n_used) {
    await page.click(`#place_${k}`);
    const state = await settled(page);
    const size = Math.max(report.length, ...report.places[k].at.map(Math.abs));
    require_near(state.camera.target, report.places[k].at, k_f32 * size, `camera's target at place ${k}`);
    require_equal(state.pin.at, report.places[k].at, `pin of place ${k}`);
    require_that(state.pin.on_screen, `the pin of place ${k} is not in the picture`);
    if (k === 0 || k === step) await shot(`place_${k}`);
  }
  for (const name of ["next", "previous"]) await page.click(`#place_${name}`);
  for (const gate of new Set(report.places.map((place) => place.gate))) {
    await page.selectOption("#gate_filter", gate);
    require_equal((await state_of(page)).drawn.markers, report.places.filter((place) => place.gate === gate).length, `markers of ${gate}`);
  }
  await page.selectOption("#gate_filter", "");
  await page.click("#place_none");
  require_equal((await state_of(page)).pin, null, "pin of no place");
  await page.click("#places_markers");
  await page.click("#view_iso");
  return n_used;
}

async function use_gates(page, report) {
  await tab(page, "summary");
  require_equal((await page.$$(".gate")).length, report.gates.length, "rows of gates");
  const n = (await page.$$(".gate button")).length;
  for (let k = 0; k < n; ++k) {
    await page.click("#tab_summary");
    await (await page.$$(".gate button"))[k].click();
    require_that(["places", "histograms"].includes((await state_of(page)).values.tab), "a button of a gate leads nowhere");
  }
  if (await page.$("#gate_filter")) await page.click("#tab_places").then(() => page.selectOption("#gate_filter", ""));
}

async function use_histograms(page, report, shot) {
  if (!report.histograms.length) return;
  await tab(page, "histograms");
  await page.waitForTimeout(100);
  for (const _ of [0, 1]) await page.click("#log_counts");
  const blank = await page.evaluate(() =>
    [...document.querySelectorAll(".histogram canvas")].filter((canvas) => {
      const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      return !bytes.some((byte) => byte !== 0);
    }).length,
  );
  require_equal(blank, 0, "blank histograms");
  await page.hover(".histogram canvas");
  await shot("histograms");
}

/** Each change is told, each place in it is shown. */
async function use_changes(page, report, shot) {
  const changes = report.manifest?.changes ?? [];
  await tab(page, "summary");
  require_equal((await page.$$(".surface_changes h3")).length, changes.length, "changes of the surface");
  if (!changes.length) return;
  const text = (await page.textContent("#body_summary")).replaceAll(/\s+/g, " ");
  for (const change of changes) for (const part of change.slice(change.indexOf(": ") + 1).split("; ")) require_that(text.includes(part.trim().replaceAll(/\s+/g, " ")), `the summary does not tell "${part}"`);
  const places = await page.$$(".surface_change button");
  if (places.length) {
    await places[0].click();
    const state = await settled(page);
    require_that(state.values.place < 0, "a change is no place of a gate");
    await require_picture(page, "place of a change", 0);
    await shot("change");
  }
}

async function use_run(page, report, shot) {
  if (report.coverage.length) {
    await tab(page, "coverage");
    await shot("coverage");
  }
  if (!report.run && !report.manifest) return;
  await tab(page, "run");
  await shot("run");
  if (await page.$("#options_search")) {
    const rows = () => page.$$eval(".options tr", (list) => list.length);
    const all = await rows();
    await page.fill("#options_search", "first_height");
    require_that((await rows()) <= all, "the search adds options");
    await page.fill("#options_search", "no such option");
    require_equal(await rows(), 0, "options that are not there");
    await page.fill("#options_search", "");
  }
  for (const summary of await page.$$(".tree summary")) await summary.click();
}

/** A link opens where it was made. */
async function use_link(page, open, file, report, shot) {
  if (report.cuts.length) await page.click("#tab_cuts").then(() => page.click("#cut_0"));
  await settled(page);
  await page.focus("canvas.view_canvas");
  await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(600); // the address is written a little later
  const before = await state_of(page);
  const hash = await page.evaluate(() => location.hash);
  require_that(hash.length > 1, "the address keeps nothing");
  const other = await open(file, hash);
  const after = await settled(other);
  require_equal({ ...after.values, options_filter: "" }, { ...before.values, options_filter: "" }, "state behind a link");
  require_near(after.camera.target, before.camera.target, 1e-5 * report.length, "camera's target behind a link");
  require_near([after.camera.distance], [before.camera.distance], 1e-4 * before.camera.distance, "camera's distance behind a link");
  if (typeof report.surface.fields[0]?.min === "number") {
    const third = await open(file, `#tab=surface&color=${encodeURIComponent(report.surface.fields[0].name)}`);
    require_that((await third.inputValue("#range_low")) !== "", "no range behind a link to a field");
    await third.close();
  }
  if (report.places.length) await use_place_link(open, file, report);
  await other.emulateMedia({ colorScheme: "dark", reducedMotion: "no-preference" });
  await other.click("#tab_surface");
  await other.click("#view_side"); // a real flight
  await settled(other);
  await require_picture(other, "dark");
  await other.screenshot({ path: (await shot("link"), file.replace(/\.html$/, "_dark.png")) });
  require_no_complaints(other, "behind a link");
  await other.close();
}

/** A short link, as one writes it by hand. */
async function use_place_link(open, file, report) {
  const page = await open(file, "#place=0");
  const state = await settled(page);
  require_equal(state.values.tab, "places", "tab of a link to a place");
  require_near(state.camera.target, report.places[0].at, k_f32 * Math.max(report.length, ...report.places[0].at.map(Math.abs)), "camera's target behind a link to a place");
  require_that(state.pin, "no pin behind a link to a place");
  require_no_complaints(page, "behind a link to a place");
  await page.close();
}
