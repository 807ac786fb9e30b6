// Makes pages out of the template, good and damaged, and browses them.
// usage: node browse_fixtures.mjs TEMPLATE.html OUT_FOLDER
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { browse, k_browser } from "./browse_report.mjs";
import { require_no_complaints, require_that, with_browser } from "./browser.mjs";
import { k_nasty, make_bare_report, make_report, make_series } from "./fixture_reports.mjs";
import { packed_page } from "./pack_page.mjs";

const [template_file, folder] = process.argv.slice(2);
const template = await readFile(template_file, "utf8");
await mkdir(folder, { recursive: true });

async function write(name, report, blob_text) {
  const file = path.join(folder, `${name}.html`);
  await writeFile(file, packed_page(template, report, blob_text));
  return file;
}

/** Pages that cannot be shown say why, in words that hold `words`; the rest of the page (when `has_tables`) is there. */
async function require_sentence(open, file, words, { has_tables = false } = {}) {
  const page = await open(file);
  const text = await page.evaluate(() => [...document.querySelectorAll(".fatal, .view_message")].map((element) => element.textContent).join(" "));
  require_that(text.includes(words), `${file} says "${text}" instead of "${words}"`);
  if (has_tables) {
    require_that((await page.$$(".gate")).length > 0, `${file}: the tables are missing`);
    for (const tab of await page.$$(".tab")) await tab.click();
    for (const id of ["view_top", "toggle_edges", "save_picture", "tab_cuts", "cut_0", "tab_places", "place_1"]) await page.click(`#${id}`);
    await page.screenshot({ path: file.replace(/\.html$/, ".png") });
  }
  require_no_complaints(page, file);
  await page.close();
  console.log(`${path.basename(file)}: says "${words}"`);
}

async function run() {
  const { report, blob } = make_report();
  const whole = await write("report", report, blob.text());
  require_that(!(await readFile(whole, "utf8")).includes(k_nasty), "names are not escaped");
  console.log(`report: ${await browse(whole, path.join(folder, "report"))}`);
  const bare = make_bare_report();
  console.log(`bare: ${await browse(await write("bare", bare.report, bare.blob.text()), path.join(folder, "bare"))}`);
  console.log(`series: ${await browse(await write("series", make_series(), ""), path.join(folder, "series"))}`);

  await with_browser({ executable: k_browser, has_webgl: false }, ({ open }) => require_sentence(open, whole, "no WebGL 2", { has_tables: true }));
  await with_browser({ executable: k_browser }, ({ open }) => open_damaged(open, report, blob));
}

async function open_damaged(open, report, blob) {
  const good = blob.text();
  const changed = (changes) => ({ ...report, surface: { ...report.surface, ...changes } });
  const empty = path.join(folder, "empty.html");
  await writeFile(empty, template);
  await require_sentence(open, empty, "empty template");
  const damaged = async (name, words, page, blob_text = good, options = {}) => require_sentence(open, await write(name, page, blob_text), words, options);
  await damaged("cut_json", "its JSON cannot be read", JSON.stringify(report).slice(0, 5000));
  await damaged("other_schema", 'this report has "sterna-report-9"', { schema: "sterna-report-9" });
  await damaged("no_table", 'its table "gates" is missing', { ...report, gates: undefined });
  await damaged("no_surface", "its surface is missing", { ...report, surface: null });
  const { points, edges } = report.surface;
  const tables = { has_tables: true };
  await damaged("cut_blob", "cannot be unpacked", report, good.slice(0, good.length / 2), tables);
  await damaged("no_base64", "cannot be unpacked", report, "?? no base64 ??", tables);
  await damaged("short_blob", "but there are", changed({ points: { ...points, at: blob.size - 4 } }), good, tables);
  await damaged("wrong_type", "has type u8 instead of u16", changed({ patch: edges }), good, tables);
  await damaged("far_corner", "a triangle has corner", changed({ points: { ...points, n: 3 } }), good, tables);
  await damaged("odd_offset", "not at a multiple of 4", changed({ edges: { ...edges, at: edges.at + 1 } }), good, tables);
}

try {
  await run();
} catch (error) {
  console.error(error.stack ?? error);
  process.exit(1);
}
