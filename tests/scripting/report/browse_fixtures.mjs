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
async function require_sentence(file, words, { has_tables = false, has_webgl = true } = {}) {
  await with_browser({ executable: k_browser, has_webgl }, async ({ open }) => {
    const page = await open(file);
    const text = await page.evaluate(() => [...document.querySelectorAll(".fatal, .view_message")].map((element) => element.textContent).join(" "));
    require_that(text.includes(words), `${file} says "${text}" instead of "${words}"`);
    if (has_tables) {
      require_that((await page.$$(".gate")).length > 0, `${file}: the tables are missing`);
      for (const tab of await page.$$(".tab")) await tab.click();
      for (const id of ["view_top", "toggle_edges", "save_picture"]) await page.click(`#${id}`);
      await page.click("#tab_cuts");
      await page.click("#cut_0");
      await page.click("#tab_places");
      await page.click("#place_1");
      await page.screenshot({ path: file.replace(/\.html$/, ".png") });
    }
    require_no_complaints(page, file);
  });
  console.log(`${file}: says "${words}"`);
}

async function run() {
  const { report, blob } = make_report();
  const whole = await write("report", report, blob.text());
  require_that(!(await readFile(whole, "utf8")).includes(k_nasty), "names are not escaped");
  console.log(`report: ${await browse(whole, path.join(folder, "report"))}`);
  const bare = make_bare_report();
  console.log(`bare: ${await browse(await write("bare", bare.report, bare.blob.text()), path.join(folder, "bare"))}`);
  console.log(`series: ${await browse(await write("series", make_series(), ""), path.join(folder, "series"))}`);

  const with_changes = (changes) => ({ ...report, surface: { ...report.surface, ...changes } });
  const good = blob.text();
  const tables = { has_tables: true };
  await require_sentence(whole, "no WebGL 2", { ...tables, has_webgl: false });
  await require_sentence(await write("empty", template, "").then((file) => writeFile(file, template).then(() => file)), "empty template");
  await require_sentence(await write("cut_json", JSON.stringify(report).slice(0, 5000), good), "its JSON cannot be read");
  await require_sentence(await write("other_schema", { schema: "sterna-report-9" }, good), 'this one has "sterna-report-9"');
  await require_sentence(await write("no_table", { ...report, gates: undefined }, good), 'its table "gates" is missing');
  await require_sentence(await write("cut_blob", report, good.slice(0, good.length / 2)), "cannot be unpacked", tables);
  await require_sentence(await write("no_base64", report, "?? no base64 ??"), "cannot be unpacked", tables);
  await require_sentence(await write("short_blob", with_changes({ points: { ...report.surface.points, at: blob.size - 4 } }), good), "but there are", tables);
  await require_sentence(await write("wrong_type", with_changes({ patch: report.surface.edges }), good), "has type u8 instead of u16", tables);
  await require_sentence(await write("far_corner", with_changes({ points: { ...report.surface.points, n: 3 } }), good), "a triangle has corner", tables);
  await require_sentence(await write("odd_offset", with_changes({ edges: { ...report.surface.edges, at: report.surface.edges.at + 1 } }), good), "not at a multiple of 4", tables);
}

try {
  await run();
} catch (error) {
  console.error(error.stack ?? error);
  process.exit(1);
}
