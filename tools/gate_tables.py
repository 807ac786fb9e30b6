"""Prints the tables of `tools/verify_gates` from its results."""
import math
import re

OUTCOMES = ("converges", "stalls", "diverges")
VERDICTS = ("pass", "warn", "FAIL", "INVALID")
NEAR = 0.01  # relative to the length: largest distance of a location from the start of the divergence
MOVED = 2.0  # percent of drag: a larger change by a damaged mesh means a spoilt solution
# Gates of cell-centred solvers, in the order of the table. Other measures of the same cells, for node-centred solvers only, are omitted.
MEASURES = ["scaled_jacobian", "stack_growth", "interface_height", "interface_volume", "stack_angle", "first_height", "coverage", "collapsed", "layer_step", "min_dihedral", "max_dihedral", "tet_growth",
            "non_orthogonality", "skewness", "face_weight", "volume_ratio", "face_flatness", "cell_aspect_ratio", "face_tets", "cell_determinant"]


# Limits of --fail instead of the limits of the program that made the results: measure, limit, share of items that must exceed it. None: limits of the program.
tried: dict[str, tuple[float, float]] | None = None


def try_limits(rules: list[str]) -> None:
    """Reads "measure=limit" or "measure=limit:share". A share counts the items beyond the hard limit of the program."""
    global tried
    tried = {}
    for rule in rules:
        name, _, value = rule.partition("=")
        limit, _, share = value.partition(":")
        tried[name] = (float(limit), float(share or 0.0))


def is_beyond(measure: dict, limit: float, share: float) -> bool:
    if share > 0.0:
        return (measure["beyond_hard"] - measure["forced"]) / measure["total"] > share
    return measure["worst"] is not None and (measure["worst"] < limit if measure["bound"] == "lower" else measure["worst"] > limit)


def verdict(result: dict) -> str:
    """Returns the verdict of the cell-centred gates, by the program that made the result, or by the limits of --fail."""
    state = result["verdicts"].get("cell-centred", "not checked")
    if result["valid"] != "VALID":
        return "INVALID"
    if tried is None:
        return "FAIL" if state == "fail" else state
    return "FAIL" if failed_gates(result) else "warn" if state == "fail" else state


def failed_gates(result: dict) -> list[str]:
    if tried is not None:
        return [name for name, (limit, share) in tried.items() if name in result["measures"] and is_beyond(result["measures"][name], limit, share)]
    return [name for name, measure in result["measures"].items() if (measure.get("states") or {}).get("cell-centred") == "fail"]


def moved(result: dict, base: dict | None) -> tuple[float, float] | None:
    """Returns the change of drag relative to the undamaged mesh, and the change of lift relative to the larger of drag and lift, in percent."""
    if not base or base is result or "CD" not in result or "CD" not in base:
        return None
    scale = max(abs(base["CD"]), abs(base["CL"]))
    return 100.0 * (result["CD"] / base["CD"] - 1.0), 100.0 * (result["CL"] - base["CL"]) / scale


def is_spoilt(result: dict, bases: dict[str, dict]) -> bool:
    """Returns whether the run diverges, stalls, or changes drag by more than MOVED percent relative to the undamaged mesh."""
    change = moved(result, bases.get(result["of"]))
    return result["outcome"] != "converges" or (change is not None and abs(change[0]) > MOVED)


def line(result: dict) -> str:
    """Returns one line about a run, for printing during the experiment."""
    forces = f", CD {result['CD']:.5f}, CL {result['CL']:.4f}, moved by {100 * result['spread']:.2f} %" if "CD" in result else ""
    meant = f" ({result['damaged']} of {result['meant']} locations)" if "meant" in result else ""
    return f"{result['name']}{meant}: {result['cells']} cells, {verdict(result)}, {result['outcome']} at {result.get('iterations', 0):.0f}{forces}, {result.get('seconds', 0):.0f} s"


def number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"


def mesh_table(results: list[dict], bases: dict[str, dict]) -> None:
    print("| mesh | what | cells | verdict, hard limits missed | outcome, iterations | CD, CL | change over the last 50 | CD, CL against the undamaged mesh |\n|---|---|---|---|---|---|---|---|")
    for result in results:
        change = moved(result, bases.get(result["of"]))
        limits = ", ".join(f"{name} {number(result['measures'][name]['worst'])}" for name in failed_gates(result))
        what = result["what"] + (f" ({result['damaged']})" if "damaged" in result and result["damaged"] != result["meant"] else "")
        print(f"| {result['name']} | {what} | {result['cells']} | {verdict(result)}{': ' + limits if limits else ''} | {result['outcome']}, {result.get('iterations', 0):.0f} | " +
              (f"{result['CD']:.4f}, {result['CL']:.4f} | {100 * result['spread']:.2f} %" if "CD" in result else "- | -") +
              (f" | {change[0]:+.1f} %, {change[1]:+.1f} %" if change else " | -") + " |")


def value_range(values: list[float]) -> str:
    return "-" if not values else number(values[0]) if len(values) == 1 else f"{number(min(values))} to {number(max(values))}"


def gate_table(results: list[dict], bases: dict[str, dict]) -> None:
    """Prints for each gate the worst values of runs by outcome, and the outcomes of runs beyond the hard limit."""
    print("| gate | measure | hard limit | worst value of runs that converge with drag within 2 % | converge, drag moves by more | stall | diverge | beyond the limit: spoilt / all | of these alone beyond this limit |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name in MEASURES:
        rows = [(result, result["measures"][name]) for result in results if result["measures"].get(name, {}).get("worst") is not None]
        if not rows:
            continue
        measure = rows[0][1]
        hard = (measure["limits"] or {}).get("hard") if tried is None else tried.get(name, (None, 0.0))[0]
        groups: dict[str, list[float]] = {"sound": [], "moved": [], "stalls": [], "diverges": []}
        for result, m in rows:
            kind = result["outcome"] if result["outcome"] != "converges" else "moved" if is_spoilt(result, bases) else "sound"
            groups.setdefault(kind, []).append(m["worst"])
        beyond = [result for result, m in rows if name in failed_gates(result)]
        alone = [result for result in beyond if len(failed_gates(result)) == 1]
        counted = [f"{sum(is_spoilt(r, bases) for r in part)} / {len(part)}" if part else "-" for part in (beyond, alone)]
        sign = {"lower": ">=", "upper": "<="}.get(measure["bound"], "")
        print(f"| {measure['gate']} | {name} | {sign + ' ' + number(hard) if hard is not None else '-'} | " +
              " | ".join(value_range(groups[kind]) for kind in ("sound", "moved", "stalls", "diverges")) + f" | {counted[0]} | {counted[1]} |")


def verdict_table(results: list[dict], bases: dict[str, dict]) -> None:
    print("| verdict | meshes | converge | of them drag moved by more than 2 % | stall | diverge | spoilt |\n|---|---|---|---|---|---|---|")
    for name in VERDICTS:
        rows = [result for result in results if verdict(result) == name]
        if not rows:
            continue
        by_outcome = {outcome: [r for r in rows if r["outcome"] == outcome] for outcome in OUTCOMES}
        spoilt = [r for r in rows if is_spoilt(r, bases)]
        n_moved = sum(is_spoilt(r, bases) for r in by_outcome["converges"])
        print(f"| {name} | {len(rows)} | {len(by_outcome['converges'])} | {n_moved} | {len(by_outcome['stalls'])} | {len(by_outcome['diverges'])} | {100 * len(spoilt) / len(rows):.0f} % |")


def extremes(result: dict) -> list[str]:
    """Returns the measures that have one of their worst locations within NEAR of the location where the run began to diverge."""
    found = re.search(r"first at \(([-+.\de]+), ([-+.\de]+), ([-+.\de]+)\)", result["says"])
    if not found:
        return []
    origin = [float(x) for x in found.groups()]
    return [name for name, measure in result["measures"].items() if any(math.dist(origin, place) < NEAR * result["length"] for place in measure["places"])]


def divergence_table(results: list[dict]) -> None:
    print("| mesh | verdict | iteration | measures with one of their ten worst values where the divergence began |\n|---|---|---|---|")
    for result in results:
        if result["outcome"] == "diverges":
            values = [f"{name} {number(result['measures'][name]['worst'])}" for name in extremes(result)]
            print(f"| {result['name']} | {verdict(result)} | {result['iterations']:.0f} | {', '.join(values) or '-'} |")


def print_tables(results: list[dict]) -> None:
    bases = {result["name"]: result for result in results}
    sound = [result for result in results if not result["of"]]
    damaged = [result for result in results if result["of"]]
    for title, rows in (("Sound meshes", sound), ("Damaged meshes and meshes by other options", damaged)):
        print(f"\n{title}:\n")
        mesh_table(rows, bases)
    print("\nWhere runs diverge:\n")
    divergence_table(results)
    print("\nGates:\n")
    gate_table(results, bases)
    for title, rows in (("all", results), ("sound", sound), ("damaged", damaged)):
        print(f"\nVerdict against outcome, {title}:\n")
        verdict_table(rows, bases)
