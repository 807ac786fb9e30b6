// Entry point: reads the data of the page and opens the app of its schema.
import { read_json } from "./data.js";
import { ReportError } from "./errors.js";
import { ReportApp } from "./report.js";
import { SeriesApp } from "./series.js";
import { start_page } from "./start_page.js";

start_page(() => {
  const json = read_json();
  const apps = { "sterna-report-1": ReportApp, "sterna-series-1": SeriesApp };
  const App = apps[json.schema];
  if (!App) throw new ReportError(`This page shows reports of the schemas ${Object.keys(apps).join(" and ")}; this report has "${json.schema}".`);
  return new App(json);
});
