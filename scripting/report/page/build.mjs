// Bundles src/ and its libraries into one HTML file without network, src/workbench into another.
// usage: node build.mjs REPORT.html VIEW.html     (node_modules beside this file; CMake runs it in the build folder)
import { build } from "esbuild";
import { readFile, rename, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import path from "node:path";

const here = path.dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? path.join(here, "report_page.html");
const view_output = process.argv[3] ?? path.join(here, "view_page.html");
const k_max_bytes = 2.5e6; // every report carries the page

/** The bundle's text of one entry file; licences of the libraries stay in it, at the end. */
async function bundle(entry) {
  const result = await build({
    absWorkingDir: here,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["chrome111", "firefox113", "safari16.4"], // the first with DecompressionStream("gzip")
    charset: "ascii",
    legalComments: "eof",
    logLevel: "warning",
  });
  return result.outputFiles[0].text;
}

/** Text that can stand in a script or style element. */
function inlined(text, element) {
  return text.replaceAll(new RegExp(`</${element}`, "gi"), `<\\/${element}`);
}

/** Bundles an entry and its style into its template; `markers` must each be in the page once. */
async function make_page(output, folder, markers) {
  const template = await readFile(path.join(here, folder, "template.html"), "utf8");
  const script = inlined(await bundle(`${folder}/main.js`), "script");
  const style = inlined(await bundle(`${folder}/style.css`), "style");
  // Functions, because "$&" in a replacement text would be a pattern.
  const page = template.replace("/*STYLE*/", () => style).replace("/*SCRIPT*/", () => script);
  for (const marker of markers) {
    const n_found = page.split(marker).length - 1;
    if (n_found !== 1) throw new Error(`the page holds the marker ${marker} ${n_found} times instead of once`);
  }
  if (page.length > k_max_bytes) throw new Error(`the page has ${page.length} bytes, limit ${k_max_bytes}`);
  await writeFile(`${output}.tmp`, page);
  await rename(`${output}.tmp`, output);
  console.log(`${output}: ${(page.length / 1e3).toFixed(0)} kB`);
}

await make_page(output, "src", ["<!--STERNA_JSON-->", "<!--STERNA_BLOB-->"]);
await make_page(view_output, "src/workbench", []);
