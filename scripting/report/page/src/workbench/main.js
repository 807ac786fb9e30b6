// Entry of the workbench. Whatever goes wrong ends in a sentence on the page, never in a blank one.
import { fill, h } from "../dom.js";
import { ReportError, sentence_of } from "../errors.js";
import { Bench } from "./bench.js";

const root = document.getElementById("app");

function show_trouble(error) {
  const text = sentence_of(error);
  if (!root.firstElementChild || root.querySelector(".loading")) fill(root, h("p.fatal", { role: "alert" }, text));
  else root.append(h("p.fatal.below", { role: "alert" }, text));
}

window.addEventListener("error", (event) => show_trouble(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => show_trouble(event.reason));

const bench = new Bench();
// Read-only, for tests and for the curious.
window.sterna = Object.freeze({ state: () => bench.test_state(), pixels: () => bench.view?.pixels() ?? null });
bench
  .start(root)
  .then(() => (document.body.dataset.ready = "true"))
  .catch((error) => {
    show_trouble(error);
    document.body.dataset.ready = "failed";
    if (!(error instanceof ReportError)) throw error;
  });
