"""Makes a case that is wrong smaller, as long as it stays wrong in the same way."""
import copy
import shutil
import tempfile


def way(result):
    """What has to stay: the first word or two of the reason, without figures."""
    head = result["why"].partition("{")[0]
    return result["verdict"], " ".join(word for word in head.replace(":", " ").split()[:3] if not any(c.isdigit() for c in word))


def smaller(case):
    """Cases with one thing less, the larger things first."""
    for i in reversed(range(len(case.get("components", [])))):
        name = case["components"][i]["name"]
        if len(case["components"]) == 1 or any(name in part["needs"] for part in case["components"]):
            continue
        less = copy.deepcopy(case)
        del less["components"][i]
        yield f"without {name}", less
    for key, plain in (("disc", None), ("tunnel", None), ("attitude", None), ("half", None), ("triangulated", False), ("converted", None), ("offset", None), ("relative_farfield", None), ("output", ""), ("continued", None), ("through", None), ("wakes", None),
                       ("periodic", None), ("deflections", {}),
                       ("scale", "1"), ("farfield", {})):
        if case.get(key) not in (plain, None, False, "", {}):
            less = copy.deepcopy(case)
            if plain is None and key != "offset":
                del less[key]
                if key == "converted":
                    less.pop("convert", None)
            else:
                less[key] = plain
                if key == "deflections":
                    less["turned"] = []
            yield f"{key} left out", less
    for i in range(len(case.get("damage", []))):
        less = copy.deepcopy(case)
        del less["damage"][i]
        yield f"without {case['damage'][i][0]}", less
    for i, part in enumerate(case.get("components", [])):
        if part.get("after"):
            less = copy.deepcopy(case)
            less["components"][i]["after"] = part["after"][:-1]
            yield f"{part['name']} as it is", less
    for stage in ("volume", "surface"):
        for name in case.get(stage, {}):
            if name not in ("layers", "first_height", "max_edge", "size_growth", "improve_rounds"):
                less = copy.deepcopy(case)
                del less[stage][name]
                yield f"{name} left out", less


def without_triangles(case, n):
    """Surface cases with a part of their triangles taken out: halves, quarters, eighths."""
    for parts in (2, 4, 8):
        for i in range(parts):
            less = copy.deepcopy(case)
            less["removed"] = case.get("removed", []) + [[n * i // parts, n * (i + 1) // parts]]
            yield f"triangles {n * i // parts} to {n * (i + 1) // parts} taken out", less


def reduce(case, result, judge, count_triangles=None, tries=40):
    """The smallest case found that is still wrong in the same way, and what was left out on the way. `count_triangles`: of a surface case, or nothing."""
    said, asked = [], way(result)
    progress = True
    while progress and tries > 0:
        progress = False
        steps = list(smaller(case))
        n = count_triangles(case) if count_triangles and case["kind"] == "surface" else 0
        if n > 20:
            steps += list(without_triangles(case, n))
        for what, less in steps:
            if tries <= 0:
                break
            tries -= 1
            folder = tempfile.mkdtemp(prefix="soak_reduce_")
            try:
                new = judge(less, folder)
            finally:
                shutil.rmtree(folder, ignore_errors=True)
            if way(new) == asked:
                case, result, progress = less, new, True
                said.append(what)
                break
    return case, result, said
