// Entry point of the workbench.
import { start_page } from "../start_page.js";
import { Bench } from "./bench.js";

start_page(() => new Bench());
