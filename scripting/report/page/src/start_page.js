// How every page starts: whatever goes wrong ends in a sentence on the page, never in a blank one.
import { fill, h } from "./dom.js";
import { ReportError, sentence_of } from "./errors.js";

/** `open()` gives the app: start(root) fills the page, test_state() tells what it shows, view is its picture where it has one. */
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
    // Read-only, for tests and for the curious.
    window.sterna = Object.freeze({ state: () => app.test_state(), pixels: () => app.view?.pixels() ?? null, times: () => ({ ...app.times }) });
    await app.start(root);
    document.body.dataset.ready = "true";
  } catch (error) {
    show_trouble(error);
    document.body.dataset.ready = "failed";
    if (!(error instanceof ReportError)) throw error;
  }
}
