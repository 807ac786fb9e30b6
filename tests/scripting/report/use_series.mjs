// Every control of the page of a series.
import { require_equal, require_no_complaints, require_that, state_of } from "./browser.mjs";

export async function use_series({ page, open, file, report, shot }) {
  const { cases, parameters, figures } = report;
  require_equal((await state_of(page)).rows.length, cases.length, "rows");
  await shot("series");
  const chips = await page.$$eval("#cases tbody .chip", (list) => list.map((element) => [element.textContent, element.className]));
  for (const [text, classes] of chips)
    require_that(!/^(fail|warn|pass)/i.test(text) || classes.includes(text.slice(0, 4).toLowerCase()), `"${text}" has the colour of ${classes}`);
  const value_of = (key, entry) => (key.startsWith("p:") ? entry.parameters?.[key.slice(2)] : key.startsWith("f:") ? entry.figures?.[key.slice(2)] : key.startsWith("g:") ? entry.gates?.[key.slice(2)] : entry[key]);
  const keys = await page.$$eval("#cases .sort", (list) => list.map((element) => element.dataset.key));
  for (const key of keys)
    for (const is_down of [false, true]) {
      await page.click(`#cases .sort[data-key="${key}"]`);
      const { rows } = await state_of(page);
      require_equal([...rows].sort(), cases.map((entry) => entry.name).sort(), `cases sorted by ${key}`);
      const values = rows.map((name) => value_of(key, cases.find((entry) => entry.name === name)));
      const numbers = values.filter((value) => typeof value === "number");
      if (!key.startsWith("p:") && !key.startsWith("f:")) continue;
      require_that(numbers.every((x, k) => k === 0 || (is_down ? numbers[k - 1] >= x : numbers[k - 1] <= x)), `${key} is not sorted: ${numbers}`);
      require_that(values.slice(numbers.length).every((value) => typeof value !== "number"), `${key}: missing values are not last`);
    }
  await page.click(".columns summary");
  for (const box of await page.$$(".column_list input")) {
    const n_before = await page.$$eval("#cases .sort", (list) => list.length);
    await box.click();
    require_equal(await page.$$eval("#cases .sort", (list) => list.length), n_before - 1, "columns after one is taken away");
    await box.click();
  }
  await page.click(".columns summary");
  await page.click("#compare_none");
  for (const entry of cases) await page.click(`[data-compare="${CSS_escape(entry.name)}"]`);
  require_equal((await page.$$("th.compared")).length, cases.length, "cases side by side");
  const differing = (await page.$$("#compare td.differs")).length;
  require_that(cases.length < 2 || differing > 0, "no difference is marked");
  await page.click("th.compared button");
  await page.selectOption("#compare_add", cases[0].name);
  await shot("series_compare");
  for (const figure of figures) {
    await page.selectOption("#figure", `f:${figure.name}`);
    for (const over of parameters)
      for (const by of ["", ...parameters]) {
        await page.selectOption("#over", over);
        await page.selectOption("#by", by);
        const { n_points, n_lines } = await state_of(page);
        const usable = cases.filter((entry) => typeof entry.figures?.[figure.name] === "number" && (entry.parameters?.[over] ?? null) !== null);
        require_equal(n_points, usable.length, `points of ${figure.name} over ${over}`);
        const groups = by && by !== over ? new Set(usable.map((entry) => JSON.stringify(entry.parameters[by]))).size : Math.min(1, usable.length);
        require_equal(n_lines, groups, `lines of ${figure.name} over ${over} by ${by}`);
      }
  }
  await shot("series_chart");
  await page.waitForTimeout(600);
  const before = await state_of(page);
  const other = await open(file, await page.evaluate(() => location.hash));
  require_equal((await state_of(other)).values, before.values, "state behind a link");
  await other.emulateMedia({ colorScheme: "dark" });
  await other.screenshot({ path: file.replace(/\.html$/, "_dark.png") });
  require_no_complaints(other, "behind a link");
  await other.close();
  return `${cases.length} cases, ${keys.length} columns, ${figures.length} figures`;
}

/** A name inside of a quoted attribute selector. */
function CSS_escape(text) {
  return text.replace(/["\\]/g, "\\$&");
}
