// Opens a report or series page from disk and uses every control of it; fails on any complaint of the page and on broken invariants.
// usage: node browse_report.mjs PAGE.html OUT_FOLDER      (screenshots go to OUT_FOLDER)
import { mkdir } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { json_of, require_no_complaints, state_of, with_browser } from "./browser.mjs";
import { use_report } from "./use_report.mjs";
import { use_series } from "./use_series.mjs";

export const k_browser = process.env.STERNA_BROWSER ?? "/usr/bin/chromium";

/** Uses everything on a page; returns what was done, in words. \throws Failed */
export async function browse(file, folder) {
  await mkdir(folder, { recursive: true });
  let done = "";
  await with_browser({ executable: k_browser }, async ({ open }) => {
    const page = await open(file);
    const schema = (await state_of(page)).schema;
    const tools = { page, open, file, report: await json_of(page), keep: (download, name) => download.saveAs(path.join(folder, `${name}.png`)), shot: (name) => page.screenshot({ path: path.join(folder, `${name}.png`) }) };
    done = schema === "sterna-series-1" ? await use_series(tools) : await use_report(tools);
    require_no_complaints(page, "the page complained");
  });
  return done;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [file, folder] = process.argv.slice(2);
  if (!folder) {
    console.error("usage: node browse_report.mjs PAGE.html OUT_FOLDER");
    process.exit(2);
  }
  try {
    console.log(`${file}: ${await browse(file, folder)}`);
  } catch (error) {
    console.error(`${file}: ${error.stack ?? error}`);
    process.exit(1);
  }
}
