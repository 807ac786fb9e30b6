"""The tables of `tools/verify_gates`, from its results."""
OUTCOMES = ("converges", "stalls", "diverges")
VERDICTS = ("pass", "warn", "FAIL", "INVALID")
MOVED = 2.0  # percent of drag, beyond which a damaged mesh has visibly spoilt the solution


def verdict(result: dict) -> str:
    state = result["verdicts"].get("cell-centred", "not checked")
    return "INVALID" if result["valid"] != "VALID" else "FAIL" if state == "fail" else state


def moved(result: dict, base: dict | None) -> tuple[float, float] | None:
    """Percent by which drag differs from that of the undamaged mesh, and lift over the larger of drag and lift."""
    if not base or "CD" not in result or "CD" not in base:
        return None
    scale = max(abs(base["CD"]), abs(base["CL"]))
    return 100.0 * (result["CD"] / base["CD"] - 1.0), 100.0 * (result["CL"] - base["CL"]) / scale


def line(result: dict) -> str:
    """A run in words, while the tool runs."""
    forces = f", CD {result['CD']:.5f}, CL {result['CL']:.4f}, moved by {100 * result['spread']:.2f} %" if "CD" in result else ""
    return f"{result['name']}: {result['cells']} cells, {verdict(result)}, {result['outcome']} at {result.get('iterations', 0):.0f}{forces}, {result.get('seconds', 0):.0f} s"


def print_tables(results): pass
