// Every control of the workbench on real cases; whatever the page complains about is a failure.
// usage: node browse_view.mjs STERNA SCRIPTS DATA WORK
import { chromium } from "playwright-core";
import { spawn } from "node:child_process";
import { copyFile, cp, mkdir, readFile, rename, stat, writeFile } from "node:fs/promises";
import path from "node:path";
import { Failed, require_equal, require_near, require_no_complaints, require_that } from "./browser.mjs";

const [sterna, scripts, data, work] = process.argv.slice(2);
const k_patience = 120000; // ms: software rendering on a busy machine
const k_args = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const k_large = 300000; // triangles: more than those from which on surfaces are thinned
const times = {};
const children = []; // programs that were started

/** Starts sterna view; {address, end()}. */
async function start(folder, words) {
  const child = (children[children.length] = spawn(sterna, ["view", ...words, "--no-browser", "--threads", "2"], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] }));
  let said = "", complained = "";
  child.stderr.on("data", (bytes) => (complained += bytes));
  const address = await new Promise((resolve, reject) => {
    child.stdout.on("data", (bytes) => {
      said += bytes;
      const found = said.match(/http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]+\//);
      if (found) resolve(found[0]);
    });
    child.on("exit", (code) => reject(new Failed(`sterna view ended with ${code}: ${complained}`)));
  });
  const ended = new Promise((resolve) => child.on("exit", (code, signal) => resolve(code ?? signal)));
  return {
    address,
    end: async () => {
      child.kill("SIGINT");
      require_equal(await ended, 0, "exit status after Ctrl-C");
    },
  };
}

async function open(context, address) {
  const page = await context.newPage();
  page.setDefaultTimeout(k_patience); // clicks wait as long
  page.complaints = [];
  page.on("console", (message) => message.type() === "error" && !/409|410/.test(message.text()) && page.complaints.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => page.complaints.push(`error: ${error.stack ?? error}`));
  page.on("request", (request) => !request.url().startsWith(address) && !/^(data|blob):/.test(request.url()) && page.complaints.push(`the page asked for ${request.url().slice(0, 200)}`));
  await page.goto(address);
  await page.waitForFunction(() => document.body.dataset.ready, null, { timeout: k_patience });
  return page;
}

const state_of = (page) => page.evaluate(() => window.sterna.state());

/** The first state of which is_so(state, argument). */
async function wait_for(page, is_so, argument, what) {
  let state;
  for (const end = performance.now() + k_patience; performance.now() < end; await page.waitForTimeout(15)) {
    state = await state_of(page);
    if (is_so(state, argument)) return state;
  }
  throw new Failed(`${what}: waited in vain; ${JSON.stringify({ ...state, objects: undefined }).slice(0, 3000)}`);
}

const settled = (page, what) => wait_for(page, (s) => s.run.status !== "running" && s.run.status !== "starting" && s.objects.every((o) => !o.is_shown || !o.scene || s.shown.some((x) => x.key === o.key)) && !s.is_flying, null, what);
const shot = (page, name) => page.screenshot({ path: path.join(work, `${name}.png`) });
const shown_of = (state, key) => state.shown.find((object) => object.key === key);

async function require_picture(page, what) {
  const { share, colours } = await page.evaluate(() => window.sterna.pixels());
  require_that(share > 0.01 && colours > 3, `${what}: blank, ${share} of the picture, ${colours} colours`);
}

/** A pixel of the canvas where something is drawn, near the given one. */
async function pick_at(page, x, y) {
  const box = await page.locator(".view_canvas").boundingBox();
  await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  await page.waitForTimeout(150);
}

async function use_toolbar(page) {
  const orientations = new Set();
  for (const name of ["front", "back", "side", "top", "bottom", "iso"]) {
    await page.click(`#view_${name}`);
    const state = await settled(page, `view ${name}`);
    orientations.add(JSON.stringify(state.camera.orientation.map((x) => x.toFixed(3))));
    await require_picture(page, `view ${name}`);
  }
  require_equal(orientations.size, 6, "directions of view");
  await page.locator(".view_canvas").focus();
  for (const key of ["2", "1", "f", "e", "e", "ArrowLeft", "ArrowUp", "+", "-"]) await page.keyboard.press(key);
  await settled(page, "keys");
  await page.click("#view_fit");
  for (const name of await page.$$eval("#map option", (list) => list.map((option) => option.value))) await page.selectOption("#map", name);
  await page.selectOption("#map", "viridis");
  for (const name of await page.$$eval("#color option", (list) => list.map((option) => option.value))) {
    await page.selectOption("#color", name);
    await require_picture(page, `colour ${name}`);
    if (name !== "patch") require_that((await page.$$eval(".legends .legend", (list) => list.length)) > 0, `a legend for ${name}`);
  }
  await page.selectOption("#color", "patch");
  await page.click("#toggle_edges");
  require_equal((await state_of(page)).edges, false, "edges");
  await page.click("#toggle_edges");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save_picture")]);
  require_that((await stat(await download.path())).size > 5000, "the saved picture");
}

async function use_tree(page, key, component) {
  const before = shown_of(await state_of(page), key);
  require_that(before.drawn === before.triangles, "all is drawn");
  const row = page.locator(`[data-key="${key}"] [data-component="${component}"] > summary`);
  await row.locator("input").click();
  let now = shown_of(await state_of(page), key);
  require_that(now.drawn < before.drawn && now.hidden.length > 0, `${component} is hidden`);
  await page.locator(`[data-key="${key}"] [data-component="${component}"] > summary`).hover();
  await row.locator("button").click();
  now = shown_of(await state_of(page), key);
  require_that(now.drawn > 0 && now.drawn < before.drawn, `only ${component}`);
  await page.locator(`[data-key="${key}"] [data-component="${component}"] > summary`).click({ position: { x: 6, y: 12 } });
  const sections = `[data-key="${key}"] [data-component="${component} sections"]`;
  await page.click(`${sections} > summary`);
  require_that((await page.$$eval(`${sections} [data-section]`, (list) => list.length)) === 3 && (await page.$$eval(`${sections} [data-control]`, (list) => list.length)) === 2, `sections and control surfaces of ${component}`);
  require_that(/chord 6\.6 m/.test(await page.textContent(`${sections} [data-section]`)), "the root's chord");
  await page.click(`${sections} [data-section] .link`);
  require_that((await settled(page, "a section")).pin !== null, "a section is marked");
  await shot(page, "sections");
  const patch = page.locator(`[data-key="${key}"] [data-component="${component}"] [data-patch]`).first();
  await patch.locator("input").click();
  require_that(shown_of(await state_of(page), key).drawn < now.drawn, "a patch is hidden");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("a");
  require_equal(shown_of(await state_of(page), key).drawn, before.drawn, "all patches again");
  await page.keyboard.press("Escape");
  await page.click("#view_iso");
  await settled(page, "iso after the tree");
}

async function use_objects(page, key, other) {
  await page.locator(`[data-key="${other}"] > .tree_row input`).click();
  let state = await wait_for(page, (s, k) => s.shown.some((x) => x.key === k && x.drawn > 0), other, `${other} is shown`);
  await page.locator(`[data-key="${other}"] > .tree_row`).hover();
  await page.locator(`[data-key="${other}"] > .tree_row button.small`).click();
  state = await state_of(page);
  require_equal(shown_of(state, key).drawn, 0, `${key} while ${other} is alone`);
  await page.locator(`[data-key="${key}"] > .tree_row input`).click();
  await page.locator(`[data-key="${other}"] > .tree_row input`).click();
  state = await state_of(page);
  require_that(shown_of(state, key).drawn > 0 && shown_of(state, other).drawn === 0, "shown and hidden");
}

async function use_picking(page) {
  await page.click("#view_top");
  await settled(page, "top view");
  await pick_at(page, 0.5, 0.5);
  await pick_at(page, 0.56, 0.5);
  const { picks } = await state_of(page);
  require_equal(picks.length, 2, "picks");
  const wanted = Math.hypot(...picks[0].at.map((x, c) => x - picks[1].at[c]));
  const text = await page.textContent("#distance b");
  require_that(Math.abs(parseFloat(text) - wanted) < 0.001 * wanted, `distance ${text} instead of ${wanted}`);
  await page.click("#copy_lua");
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  require_that(/^patches = \{ \["[^"]+"\] = \{ max_edge = [\d.e-]+ \} \}$/.test(copied), `copied: ${copied}`);
  await page.click("#copy_place");
  await shot(page, "picking");
  await page.click("#hide_patch");
  require_that((await state_of(page)).shown.some((object) => object.hidden.length > 0), "the picked patch is hidden");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("a");
  await page.keyboard.press("Escape");
  require_equal((await state_of(page)).picks.length, 0, "no picks");
  await page.click("#view_iso");
  await settled(page, "iso");
}

/** Moves a slider as a hand does; ms from each movement until its picture is in the page, and until it is drawn (here without a graphics card). */
async function drag(page, name, values, key, is_there) {
  const latencies = [], drawn = [];
  for (const value of values) {
    const before = (await state_of(page)).times.scene;
    const begun = await page.evaluate(([id, v]) => {
      const slider = document.getElementById(id);
      slider.value = v;
      const now = performance.now();
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      return now;
    }, [`slider_${name}`, String(value)]);
    await page.waitForFunction((t) => window.sterna.times().scene > t && window.sterna.times().drawn > window.sterna.times().scene, before, { polling: 5, timeout: k_patience });
    const state = await wait_for(page, is_there, { value, before, key }, `${name} = ${value} while dragging`);
    latencies.push(state.times.scene - begun);
    drawn.push(state.times.drawn - begun);
  }
  await page.evaluate((id) => document.getElementById(id).dispatchEvent(new Event("change", { bubbles: true })), `slider_${name}`);
  return { page: latencies.map((x) => Math.round(x)), drawn: drawn.map((x) => Math.round(x)) };
}

async function replace(file, from, to) {
  const text = await readFile(file, "utf8");
  require_that(text.includes(from), `${file} has no ${from}`);
  await writeFile(`${file}.new`, text.replace(from, () => to));
  await rename(`${file}.new`, file);
}

/** Both pictures from one camera: what is picked at the left is of the run before. */
async function use_both_sides(page) {
  await page.click("#side_by_side");
  let state = await state_of(page);
  require_that(state.is_split && !state.is_before && state.before.some(({ key, drawn }) => key === "model" && drawn > 0), "the run before stands beside this one");
  await page.click("#view_top");
  await settled(page, "both from above");
  await require_picture(page, "both");
  await pick_at(page, 0.25, 0.5);
  await pick_at(page, 0.75, 0.5);
  const { picks } = await state_of(page);
  require_equal(picks.map(({ picture }) => picture), [0, 1], "pictures of the picks");
  require_near(picks[0].at, picks[1].at, 0.2, "the same place at both sides");
  await shot(page, "both_sides");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("Escape");
  await page.click("#view_iso");
  await settled(page, "both");
  await shot(page, "side_by_side");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("s");
  state = await state_of(page);
  require_that(!state.is_split && state.before.length === 0, "one picture again");
}

const k_series = `series{ "twist", over = { twist = { -4, 0, 4, 99 } }, case = function(p)
  if p.twist > 90 then error "no such wing" end
  local model = wing{ name = "wing", symmetric = true, position = { 0, 0, 0 }, sections = {
    { y = 0, chord = 1, airfoil = "naca0012", twist = p.twist*deg }, { y = 2, chord = 0.6 } } }
  local mesh = volume_mesh{ surface_mesh{ aircraft{ model }, max_edge = 0.3, curvature_angle = 30*deg }, layers = 3, first_height = 2e-3, farfield = sphere{ radius = 8 } }
  if p.twist == 0 then draw{ mesh, "wing.png" } end
  return mesh:write(p.name .. ".su2") end }
`;

/** A series that has run: pictures, table, a click to the case, two cases side by side. */
async function use_series(context) {
  const folder = path.join(work, "series");
  await mkdir(folder);
  await writeFile(path.join(folder, "series.lua"), k_series);
  const run = spawn(sterna, ["run", "series.lua", "--threads", "2"], { cwd: folder, stdio: "ignore" });
  await new Promise((resolve) => run.on("exit", resolve));
  const program = await start(folder, ["twist"]);
  const page = await open(context, program.address);
  let state = await settled(page, "the series");
  require_equal([state.is_in_cases, state.cases.n, state.cases.current], [true, 4, 1], "cases");
  require_equal(await page.$$eval(".case_card", (list) => list.filter((card) => card.disabled).length), 1, "cases without a mesh");
  state = await wait_for(page, (s) => s.run.status === "done", null, "the first case");
  require_equal(state.cases.pictures, 1, "pictures that the cases have written");
  await page.click("#take_pictures");
  await wait_for(page, (s) => s.cases.pictures === 3, null, "pictures of the cases");
  await page.waitForFunction(() => !document.querySelector("#take_pictures").disabled, null, { timeout: k_patience });
  await page.click('#case_table [data-key="p_twist"]');
  await page.click('#case_table [data-key="p_twist"]');
  require_that((await page.textContent("#case_table tbody tr .case_name")).includes("99"), "sorted downwards");
  require_that((await page.$$eval("#case_table tbody tr:nth-child(2) .chip", (list) => list.length)) > 5, "gates of a case");
  await shot(page, "cases");
  await page.click('.case_card[data-case="twist=0"]');
  state = await wait_for(page, (s) => s.cases.current === 2 && s.run.status === "done" && !s.is_in_cases, null, "a case by one click");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("c");
  require_equal((await state_of(page)).is_in_cases, true, "key C");
  await page.click('#case_table [data-case="twist=4"] .link');
  await wait_for(page, (s) => s.cases.current === 3 && s.run.status === "done" && !s.is_in_cases, null, "a case of the table");
  await settled(page, "the third case");
  await page.click("#tab_compare");
  await page.click("#side_by_side");
  state = await wait_for(page, (s) => s.before.some(({ drawn }) => drawn > 0), null, "two cases side by side");
  require_that((await page.$$eval("#compare tbody tr", (list) => list.length)) > 10, "gates of both cases");
  require_that((await page.$$eval("#compare tr.changed", (list) => list.length)) > 0, "what differs between the cases");
  await shot(page, "cases_side_by_side");
  await page.click("#show_cases");
  await page.click("#cases_close");
  require_no_complaints(page, "the series");
  await program.end();
  await page.close();
}

async function use_airliner(context) {
  const folder = path.join(work, "airliner");
  await mkdir(folder);
  const file = path.join(folder, "03_airliner.lua");
  await copyFile(path.join(scripts, "03_airliner.lua"), file);
  await cp(path.join(scripts, "data"), path.join(folder, "data"), { recursive: true });
  const begin = performance.now();
  const program = await start(folder, ["03_airliner.lua"]);
  const page = await open(context, program.address);
  await wait_for(page, (s) => s.shown.some((x) => x.drawn > 0), null, "the first picture");
  times.airliner_first_picture = Math.round(performance.now() - begin);
  let state = await wait_for(page, (s) => s.run.status === "done" && s.shown.some((x) => x.key === "model" && x.is_quick === false), null, "the united airliner");
  times.airliner_united = Math.round(performance.now() - begin);
  require_near(state.shown[0].box[1].map((x, c) => x - state.shown[0].box[0][c]).slice(1, 2), [34], 0.3, "span") // with the round tips;
  require_equal(state.parameters.map((p) => p.name), ["span", "sweep", "dihedral", "aileron"], "arguments, in the order of the script");
  await settled(page, "the airliner");
  await shot(page, "airliner");
  await use_toolbar(page);
  await page.selectOption("#color", "curvature");
  await shot(page, "curvature");
  await page.selectOption("#color", "patch");
  await use_tree(page, "model", "wing");
  await use_objects(page, "model", "main_wing");
  await use_picking(page);

  // Arguments: dragged, typed, beyond the limit, written back, reset.
  times.slider_latency = await drag(page, "span", [35, 36, 37, 38, 39, 40, 39, 38, 37, 36], "model", (s, { value, before, key }) => s.times.scene > before && s.shown.some((x) => x.key === key && Math.abs(x.box[1][1] - x.box[0][1] - value) < 0.3));
  state = await settled(page, "after dragging");
  await wait_for(page, (s) => s.run.mode === "geometry" && s.run.status === "done" && s.values.span === "36", null, "geometry after dragging");
  await shot(page, "dragged");
  await page.fill("#value_span", "60");
  await page.press("#value_span", "Enter");
  state = await wait_for(page, (s) => s.run.status === "failed", null, "a value beyond its limit");
  require_that(state.problems[0].text.includes("above the maximum"), state.problems[0].text);
  await page.click("#reset_values");
  state = await wait_for(page, (s) => s.run.status === "done" && Object.keys(s.values).length === 0, null, "reset");
  await page.fill("#value_aileron", "12");
  await page.press("#value_aileron", "Enter");
  await wait_for(page, (s) => s.run.status === "done" && s.values.aileron === "12", null, "aileron");
  await page.click("#save_values");
  await wait_for(page, (s) => s.run.status === "done" && Object.keys(s.values).length === 0, null, "written to the script");
  require_that((await readFile(file, "utf8")).includes("aileron = number{ 12, min"), "the script's new default");

  // The file is edited, broken, mended.
  const length = (s) => s.shown.find((x) => x.key === "model").box;
  const saved = performance.now();
  await replace(file, "tip_chord = 1.5", "tip_chord = 2.5");
  const n_before = (await state_of(page)).run.number;
  await wait_for(page, (s, n) => s.run.number > n && s.shown.some((x) => x.key === "model" && x.is_quick), n_before, "a sketch of the changed wing");
  times.save_to_sketch = Math.round(performance.now() - saved);
  await wait_for(page, (s, n) => s.run.number > n && s.run.status === "done" && s.shown.some((x) => x.key === "model" && x.is_quick === false), n_before, "the changed wing");
  times.save_to_united = Math.round(performance.now() - saved);
  require_that(length(await state_of(page)).length === 2, "a box");
  await page.click("#tab_compare");
  await page.click("#flick");
  require_equal((await state_of(page)).is_before, true, "the one before");
  await page.click("#compare_only");
  require_that((await page.$$eval("#compare tbody tr", (list) => list.length)) > 0, "what has changed");
  require_that((await page.$$eval("#compare tbody tr td:nth-child(2)", (list) => list.map((cell) => cell.textContent))).every((text) => text !== "\u2013"), "both runs have measures");
  await shot(page, "compare");
  await page.click("#flick");
  await use_both_sides(page);
  await replace(file, "chord = p.tip_chord", "cord = p.tip_chord");
  state = await wait_for(page, (s) => s.run.status === "failed" && s.old, null, "the broken line");
  require_that(state.problems.some((problem) => problem.line > 0 && /did you mean "?chord/.test(problem.text)), JSON.stringify(state.problems));
  await page.click("#show_problem");
  await page.waitForSelector("#script_tab .line_problem");
  await shot(page, "broken");
  await replace(file, "cord = p.tip_chord", "chord = p.tip_chord");
  await wait_for(page, (s) => s.run.status === "done" && !s.old, null, "the mended line");
  for (const tab of ["object", "mesh", "inspect", "cuts", "log", "script"]) {
    await page.click(`#tab_${tab}`);
    await page.waitForSelector(`#body_${tab}:not([hidden])`);
  }
  await page.click("#run_again");
  await settled(page, "run again");
  require_no_complaints(page, "the airliner");
  await program.end();
  await page.close();
}

async function use_cpacs(context) {
  const folder = path.join(work, "cpacs");
  await mkdir(folder);
  await copyFile(path.join(data, "cpacs", "simpletest.cpacs.xml"), path.join(folder, "simpletest.cpacs.xml"));
  await writeFile(
    path.join(folder, "case.lua"),
    `local p = args{ layers = 6, max_edge = number{ 0.12, min = 0.05, max = 0.3, unit = m } }
local model = read_cpacs "simpletest.cpacs.xml"
local united = union{ model }
local surface = surface_mesh{ united, max_edge = p.max_edge }
local mesh = volume_mesh{ surface, layers = p.layers, first_height = 1e-3, farfield = sphere{ radius = 20 } }
mesh:write "case.vtu"
`,
  );
  const program = await start(folder, ["case.lua", "max_edge=0.2"]);
  const page = await open(context, program.address);
  let state = await wait_for(page, (s) => s.run.status === "done" && s.shown.some((x) => x.key === "united" && x.is_quick === false), null, "the CPACS aircraft");
  require_equal(state.values.max_edge, "0.2", "the argument of the command line");
  await page.click("#mesh_now");
  await wait_for(page, (s) => s.run.mode === "mesh" && s.run.status === "running", null, "meshing");
  await page.click("#tab_log");
  state = await wait_for(page, (s) => s.run.mode === "mesh" && s.run.status !== "running" && s.shown.some((x) => x.key === "mesh"), null, "the mesh");
  require_equal([state.run.status, state.problems], ["done", []], "the mesh's run");
  require_that(state.n_lines > 0, "a log");
  require_that((await stat(path.join(folder, "case.vtu"))).size > 0, "the file that the script writes");
  await page.click("#tab_mesh");
  require_that((await page.$$eval("#mesh_tab .gate", (list) => list.length)) > 5, "gates");
  require_equal(shown_of(await state_of(page), "mesh").hidden, ["farfield"], "a farfield is hidden at first");
  for (const names of [[], ["farfield"]]) {
    await page.locator('[data-key="mesh"] [data-patch="farfield"] input').click();
    require_equal(shown_of(await state_of(page), "mesh").hidden, names, "the farfield");
  }
  await page.click("#view_fit");
  await page.click("#place_0");
  state = await settled(page, "a place");
  require_that(state.pin !== null, "a place is marked");
  await shot(page, "place");
  for (const name of await page.$$eval("#color option", (list) => list.map((option) => option.value))) {
    await page.selectOption("#color", name);
    await require_picture(page, `colour ${name}`);
  }
  await page.selectOption("#color", "layer_height");
  await page.click("#view_iso");
  await settled(page, "iso");
  await shot(page, "layer_height");
  await page.selectOption("#color", "patch");

  // A plane dragged through the cells.
  await page.click("#tab_cuts");
  const cuts = new Set();
  for (const place of [150, 200, 230]) {
    await page.evaluate((v) => {
      const slider = document.getElementById("cut_place");
      slider.value = v;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, place);
    const last = [...cuts].at(-1) ?? "";
    state = await wait_for(page, (s, l) => s.cut && s.cut.name !== l && s.cut.n > 0, last, "a cut");
    cuts.add(state.cut.name);
  }
  require_equal(cuts.size, 3, "cuts");
  for (const name of await page.$$eval("#cut_color option", (list) => list.map((option) => option.value))) await page.selectOption("#cut_color", name);
  for (const name of ["show", "hide", "clip"]) await page.selectOption("#cut_around", name);
  await page.selectOption("#cut_axis", "x");
  await wait_for(page, (s) => s.cut?.name.startsWith("x="), null, "a cut across x");
  await page.selectOption("#cut_axis", "y");
  await wait_for(page, (s) => s.cut?.name.startsWith("y="), null, "a cut across y");
  await page.selectOption("#cut_color", "kind");
  await page.click("#cut_look");
  await settled(page, "the cut");
  await shot(page, "cut");
  await pick_at(page, 0.5, 0.2);
  await pick_at(page, 0.3, 0.3);
  const { picks } = await state_of(page);
  require_equal(picks.map(({ kind }) => kind), ["cell", "cell"], "picks of cells");
  const wanted = Math.hypot(...picks[0].at.map((x, c) => x - picks[1].at[c]));
  require_that(wanted > 0 && Math.abs(parseFloat(await page.textContent("#distance b")) - wanted) < 0.001 * wanted, "the distance of two cells");
  await shot(page, "cut_distance");
  await page.keyboard.press("Escape");
  await page.click("#cut_none");
  require_equal((await state_of(page)).cut, null, "no cut");

  // What an inspection finds on the surface, with places to fly to.
  await page.locator('[data-key="surface"] > .tree_row input').click();
  await wait_for(page, (s) => s.shown.some((x) => x.key === "surface" && x.drawn > 0), null, "the surface");
  await page.click("#tab_inspect");
  await page.click("#inspect_start");
  await page.waitForSelector("#inspect_tab h2 .chip", { timeout: k_patience });
  const places = await page.$$("#inspect_tab .place");
  if (places.length) {
    await places[0].click();
    require_that((await settled(page, "a finding")).pin !== null, "a finding is marked");
  }
  await shot(page, "inspect");
  await page.locator('[data-key="surface"] > .tree_row input').click();

  // Another number of layers: the mesh of before stays, old, until the new one; then both are compared. A run is stopped.
  await page.fill("#value_layers", "4");
  await page.press("#value_layers", "Enter");
  state = await wait_for(page, (s) => s.run.mode === "geometry" && s.run.status === "done" && s.values.layers === "4", null, "other layers");
  require_that(state.objects.find((object) => object.key === "mesh").is_old, "the mesh of before is old");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("m");
  await wait_for(page, (s) => s.run.mode === "mesh" && s.run.status === "running", null, "meshing again");
  await wait_for(page, (s) => s.run.mode === "mesh" && s.run.status === "done" && !s.objects.find((object) => object.key === "mesh").is_old, null, "the second mesh");
  await page.locator('[data-key="mesh"] .link').click();
  await page.click("#tab_compare");
  await page.waitForSelector("#compare tbody tr");
  await page.locator(".view_canvas").focus();
  await page.keyboard.press("b");
  require_equal((await state_of(page)).is_before, true, "the mesh before");
  await page.keyboard.press("b");
  await page.fill("#value_layers", "9");
  await page.press("#value_layers", "Enter");
  await page.click("#mesh_now");
  await wait_for(page, (s) => s.run.mode === "mesh" && s.run.status === "running", null, "meshing a third time");
  await page.click("#stop");
  await wait_for(page, (s) => s.run.status === "stopped", null, "stopped");
  require_no_complaints(page, "the CPACS aircraft");
  await program.end();
  await page.close();
}

/** A surface of so many triangles that it is thinned while the camera moves. */
async function use_large(context) {
  const folder = path.join(work, "large");
  await mkdir(folder);
  await writeFile(path.join(folder, "ball.lua"), 'surface_mesh{ aircraft{ fuselage{ name = "body", frames = { { x = 1, diameter = 1 }, { x = 4, diameter = 1.2 } }, nose_height = 0.6 } }, max_edge = 0.5 }:write "body.stl"\n');
  const ended = (child) => new Promise((resolve) => child.on("exit", resolve));
  require_equal(await ended(spawn(sterna, ["run", "ball.lua"], { cwd: folder, stdio: "ignore" })), 0, "the small surface");
  require_equal(await ended(spawn(sterna, ["convert", "body.stl", "small.stl", "--format", "STL binary"], { cwd: folder, stdio: "ignore" })), 0, "as binary STL");
  const n_small = (await readFile(path.join(folder, "small.stl"))).readUInt32LE(80);
  const parts = Math.ceil(Math.sqrt(k_large / n_small));
  const refine = path.join(path.dirname(process.argv[1]), "refine_stl.mjs");
  require_equal(await ended(spawn(process.execPath, [refine, "small.stl", "large.stl", String(parts)], { cwd: folder, stdio: "ignore" })), 0, "the large surface");
  const program = await start(folder, ["large.stl"]);
  const page = await open(context, program.address);
  let state = await wait_for(page, (s) => s.run.status === "done" && s.shown.some((x) => x.drawn >= k_large), null, "the large surface");
  require_equal(state.shown.length, 1, "objects in the picture");
  require_that(state.pace.thin > 1000 && state.pace.thin < k_large / 3, `${state.pace.thin} triangles of the thinned surface`);
  await require_picture(page, "the large surface");
  await wait_for(page, (s) => s.pace.costs[0] !== null, null, "what a frame takes");
  const box = await page.locator(".view_canvas").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  const levels = new Set();
  for (let k = 1; k < 12; ++k) {
    await page.mouse.move(box.x + box.width / 2 + 8 * k, box.y + box.height / 2);
    levels.add((await state_of(page)).pace.level);
  }
  await shot(page, "large_moving");
  await page.mouse.up();
  require_that(Math.max(...levels) > 0 || (await state_of(page)).pace.costs[0] < 40, "frames are thinned while the camera moves, unless they are quick");
  await wait_for(page, (s) => !s.pace.is_moving && (s.pace.level === 0 || s.pace.costs[0] > 1000), null, "all of it at rest, unless that takes very long");
  require_no_complaints(page, "the large surface");
  await program.end();
  await page.close();
}

const browser = await chromium.launch({ executablePath: process.env.STERNA_BROWSER ?? "/usr/bin/chromium", args: k_args });
try {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", permissions: ["clipboard-read", "clipboard-write"] });
  await use_airliner(context);
  await use_cpacs(context);
  await use_series(context);
  await use_large(context);
  const dark = await browser.newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", colorScheme: "dark" });
  const program = await start(path.join(work, "airliner"), ["03_airliner.lua"]);
  const page = await open(dark, program.address);
  await wait_for(page, (s) => s.run.status === "done" && s.shown.length > 0, null, "in the dark");
  await shot(page, "dark");
  require_no_complaints(page, "in the dark");
  await program.end();
  await writeFile(path.join(work, "times.json"), JSON.stringify(times, null, 1));
  console.log(JSON.stringify(times));
} catch (error) {
  console.error(error instanceof Failed ? `FAILED: ${error.message}` : error);
  process.exitCode = 1;
} finally {
  for (const child of children) if (child.exitCode === null) child.kill("SIGINT");
  await browser.close();
}
