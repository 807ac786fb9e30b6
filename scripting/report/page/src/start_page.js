// Start of every page: any failure is reported by a sentence on the page, never by a blank page.
import { fill, h } from "./dom.js";
import { ReportError, sentence_of } from "./errors.js";

/** `open()` returns the app: start(root) fills the page, test_state() returns its state, and view is its picture, if it has one. */
export async function start_page(open) {
  const root = document.getElementById("app");
  const show_trouble = (error) => {
    const text = sentence_of(error);
    if (!root.firstElementChild || root.querySelector(".loading")) fill(root, h("p.fatal", { role: "alert" }, text));
    else root.append(h("p.fatal.below", { role: "alert" }, text));
  };
  window.addEventListener("error", (event) => show_trouble(event.error ?? event.message));
  window.addEventListener("unhandledrejection", (event) => show_trouble(event.reason));
  try {
    const app = open();
    // read-only, for tests and for interested users
    window.sterna = Object.freeze({ state: () => app.test_state(), pixels: () => app.view?.pixels() ?? null, times: () => ({ ...app.times }) });
    await app.start(root);
    document.body.dataset.ready = "true";
  } catch (error) {
    show_trouble(error);
    document.body.dataset.ready = "failed";
    if (!(error instanceof ReportError)) throw error;
  }
}
