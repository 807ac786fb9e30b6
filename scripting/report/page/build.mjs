// Bundles src/ and its libraries into one HTML file for use without network, and src/workbench into another.
// usage: node build.mjs REPORT.html VIEW.html     (node_modules beside this file; CMake runs it in the build folder)
import { build } from "esbuild";
import { readFile, rename, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import path from "node:path";

const here = path.dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? path.join(here, "report_page.html");
const view_output = process.argv[3] ?? path.join(here, "view_page.html");
const k_max_bytes = 2.5e6; // every report contains the page

/** Returns the bundle of one entry file. The licences of the libraries are at its end. */
async function bundle(entry) {
  const result = await build({
    absWorkingDir: here,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["chrome111", "firefox113", "safari16.4"], // the first versions with DecompressionStream("gzip")
    charset: "ascii",
    legalComments: "eof",
    logLevel: "warning",
  });
  return result.outputFiles[0].text;
}

/** Returns text that is safe in a script or style element. */
function inlined(text, element) {
  return text.replaceAll(new RegExp(`</${element}`, "gi"), `<\\/${element}`);
}

/** Bundles an entry and its style into the template, and replaces the marks of the template by `texts`. Each of `markers` must be in the page exactly once. */
async function make_page(output, folder, texts, markers) {
  let page = await readFile(path.join(here, "src/template.html"), "utf8");
  const script = inlined(await bundle(`${folder}/main.js`), "script");
  const style = inlined(await bundle(`${folder}/style.css`), "style");
  // Functions are used because "$&" in a replacement string would be a pattern. The bundle is inserted last, so no mark is searched in it.
  for (const [mark, text] of Object.entries({ ...texts, STYLE: style, SCRIPT: script })) page = page.replace(`/*${mark}*/`, () => text);
  for (const marker of markers) {
    const n_found = page.split(marker).length - 1;
    if (n_found !== 1) throw new Error(`the page holds the marker ${marker} ${n_found} times instead of once`);
  }
  if (page.length > k_max_bytes) throw new Error(`the page has ${page.length} bytes, limit ${k_max_bytes}`);
  await writeFile(`${output}.tmp`, page);
  await rename(`${output}.tmp`, output);
  console.log(`${output}: ${(page.length / 1e3).toFixed(0)} kB`);
}

await make_page(
  output,
  "src",
  {
    CONNECT: "",
    ICON: "%232f6db3",
    TITLE: "sterna report",
    LOADING: "Unpacking the report &hellip;",
    SUBJECT: "This report",
    DATA: '<script id="sterna-json" type="application/json"><!--STERNA_JSON--></script>\n<script id="sterna-blob" type="text/plain"><!--STERNA_BLOB--></script>\n',
  },
  ["<!--STERNA_JSON-->", "<!--STERNA_BLOB-->"],
);
await make_page(
  view_output,
  "src/workbench",
  { CONNECT: " connect-src 'self';", ICON: "%233c9a4e", TITLE: "sterna view", LOADING: "Opening the workbench &hellip;", SUBJECT: "The workbench", DATA: "" },
  [],
);
