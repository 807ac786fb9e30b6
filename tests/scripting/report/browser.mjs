// A browser without network over pages on disk; whatever the page complains about is a failure.
import { chromium } from "playwright-core";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";

const k_usual = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const k_software_webgl = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
export const k_patience = 60000; // ms, for a page to be ready: software rendering on a busy machine

export class Failed extends Error {}

export function require_that(is_so, what) {
  if (!is_so) throw new Failed(what);
}

export function require_equal(value, wanted, what) {
  require_that(JSON.stringify(value) === JSON.stringify(wanted), `${what}: ${JSON.stringify(value)} instead of ${JSON.stringify(wanted)}`);
}

/** Largest difference of two positions below `tolerance`. */
export function require_near(value, wanted, tolerance, what) {
  const worst = Math.max(...wanted.map((x, k) => Math.abs(x - value[k])));
  require_that(worst <= tolerance, `${what}: ${JSON.stringify(value)} instead of ${JSON.stringify(wanted)}, ${worst} > ${tolerance}`);
}

/** Runs use({open}) with a browser of its own, whose folder is removed afterwards. `has_webgl` false: a browser without. */
export async function with_browser({ executable, has_webgl = true }, use) {
  const folder = await mkdtemp(path.join(tmpdir(), "sterna_browser_"));
  const context = await chromium.launchPersistentContext(folder, {
    executablePath: executable,
    args: [...k_usual, ...(has_webgl ? k_software_webgl : ["--disable-3d-apis"])],
    viewport: { width: 1240, height: 760 },
    reducedMotion: "reduce",
    offline: true,
  });
  try {
    await use({ open: (file, hash = "") => open(context, file, hash) });
  } finally {
    await context.close();
    await rm(folder, { recursive: true, force: true });
  }
}

/** Opens a page from disk and waits until it says that it is ready; page.complaints collects errors. */
async function open(context, file, hash) {
  const page = await context.newPage();
  page.setDefaultTimeout(k_patience); // clicks wait as long
  const address = pathToFileURL(path.resolve(file)).href;
  page.complaints = [];
  page.on("console", (message) => message.type() === "error" && page.complaints.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => page.complaints.push(`error: ${error.stack ?? error}`));
  page.on("requestfailed", (request) => page.complaints.push(`request failed: ${request.url().slice(0, 200)}`));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(address) && !/^(data|blob):/.test(url)) page.complaints.push(`the page asked for ${url.slice(0, 200)}`);
  });
  page.on("dialog", (dialog) => {
    page.complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  await page.goto(address + hash);
  await page.waitForFunction(() => document.body.dataset.ready, null, { timeout: k_patience });
  return page;
}

export function require_no_complaints(page, during) {
  require_that(page.complaints.length === 0, `${during}: ${page.complaints.join("\n")}`);
}

export const state_of = (page) => page.evaluate(() => window.sterna.state());
export const pixels_of = (page) => page.evaluate(() => window.sterna.pixels());
export const json_of = (page) => page.evaluate(() => JSON.parse(document.getElementById("sterna-json").textContent));
