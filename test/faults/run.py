"""Measures what the tests notice: applies one fault after the other to a copy of the tree and runs the tests that can.

Faults are the patches of patches/ and the sampled mutants of mutants.jsonl. What a test reaches is recorded once by
running all tests (hook/blocks.py). The tests that reach a changed line run lowest level first, the most specific
and quickest of a level first, until one fails or the time is up. Results are kept in record.json, one column a suite.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import json
import os
import pickle
import queue
import re
import shutil
import signal
import statistics
import subprocess
import sys
import threading
import time
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
HOOK = HERE / "hook"
sys.path.insert(0, str(HOOK))
import blocks as hook  # noqa: E402

SCRATCH = ROOT / ".ws" / "faults"
RECORD, MUTANTS, PATCHES = HERE / "record.json", HERE / "mutants.jsonl", HERE / "patches"
LEVELS = ("unit", "logic", "robot", "ros", "slow")
USUAL = ("logic", "robot", "ros")
COPIED = ["--exclude=./" + name for name in (".git", ".venv", ".ws", "demo_output", "soak_output")]
# s beyond the time for tests, after which a test that runs counts as hanging.
HANGS = 150.0
MOST_TESTS = 300
FIRST_FILES = 4
# s that a test takes which must notice a fault twice.
DOUBTFUL = 0.03


class DoesNotApply(Exception):
    """A fault that the code has moved away from."""


# --- trees and processes ----------------------------------------------------------------------------------------------


def copy_tree(source, target):
    """A copy of a checkout that imports its own packages, with the interpreter and the built messages of the source."""
    shutil.rmtree(target, ignore_errors=True)
    (target / ".ws").mkdir(parents=True)
    if not (source / ".ws" / "devel" / "setup.bash").exists():
        sys.exit(f"{source} is not built: run make build there")
    pack = subprocess.Popen(["tar", "cf", "-", *COPIED, "."], cwd=source, stdout=subprocess.PIPE)
    subprocess.run(["tar", "xf", "-"], cwd=target, stdin=pack.stdout, check=True)
    for part in ("devel", "src"):
        shutil.copytree(source / ".ws" / part, target / ".ws" / part, symlinks=True)
    (target / ".venv").symlink_to((source / ".venv").resolve())
    for path in (target / ".ws" / "devel").rglob("*"):
        if path.is_file() and not path.is_symlink() and path.suffix != ".pyc":
            content = path.read_bytes()
            if os.fsencode(source) in content:
                path.write_bytes(re.sub(re.escape(os.fsencode(source)) + rb"(?![\w-])", os.fsencode(target), content))
    return target


def run_pytest(tree, arguments, log, limit=None, **variables):
    """Run pytest in a tree; whether it ended in time. What it leaves behind is ended with it."""
    script = f'export PYTHONPATH="{HOOK}:$PYTHONPATH"; exec python3 -m pytest -p faults_plugin "$@"'
    command = ["nice", "-n", "19", "scripts/ros-env", "bash", "-c", script, "-", *arguments]
    environment = {**os.environ, "PYTHONHASHSEED": "0", **variables}
    for name in ("NAO_IP", "NAO_PORT", "ROS_MASTER_URI"):
        environment.pop(name, None)
    with open(log, "w") as file:
        process = subprocess.Popen(
            command, cwd=tree, env=environment, stdout=file, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        process.wait(limit)
        return True
    except subprocess.TimeoutExpired:
        return False
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


# --- what tests reach -------------------------------------------------------------------------------------------------


class Reach:
    """Which tests reach which blocks, and how long they take."""

    def __init__(self, folder):
        self.durations, self.of_block, sizes, numbers = {}, defaultdict(set), defaultdict(list), {}
        for path in folder.glob("tests-*.txt"):
            for line in path.read_text().splitlines():
                fields = line.split("\t")
                if fields[0] == "#":
                    numbers[fields[1]] = fields[2]
                    continue
                test, outcome, took, reached = fields
                if outcome == "passed":
                    self.durations[test] = float(took)
                    blocks = [numbers[number] for number in reached.split()]
                    sizes[test.split("::")[0]].append(len(blocks))
                    for block in blocks:
                        self.of_block[block].add(test)
        for path in folder.glob("child-*.txt"):
            for line in path.read_text().splitlines():
                test, _, block = line.partition("\t")
                if test in self.durations:
                    self.of_block[block].add(test)
        self.size = {file: statistics.mean(blocks) for file, blocks in sizes.items()}
        self.in_file = defaultdict(set)
        for block, tests in self.of_block.items():
            self.in_file[block.rpartition(":")[0]] |= tests


def record_reach(suite, source, levels, jobs):
    """Run all tests once with blocks that report themselves."""
    folder = SCRATCH / suite / "reach"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "cache").mkdir(parents=True)
    tree = copy_tree(source, SCRATCH / suite / "tree-0")
    for level in levels:
        several = ["-n", str(jobs), "--dist", "loadgroup"] if jobs > 1 and level != "ros" else []
        print(f"running {level} once to see what each test reaches...", flush=True)
        patient = ["-o", "timeout=600"] if "timeout =" in (tree / "pyproject.toml").read_text() else []
        run_pytest(tree, [f"test/{level}", *several, *patient], folder / f"{level}.log", FAULTS_REACH=str(folder))
        print("  " + (folder / f"{level}.log").read_text().strip().splitlines()[-1])
    for path in folder.glob("tests-*.txt"):
        for line in path.read_text().splitlines():
            if line.split("\t")[1] == "failed":
                print(f"  failed, and is left out: {line.split(chr(9))[0]}")
    return load_reach(suite, renew=True)


def load_reach(suite, renew=False):
    folder = SCRATCH / suite / "reach"
    kept = folder / "reach.pickle"
    if renew or not kept.exists():
        kept.write_bytes(pickle.dumps(vars(Reach(folder))))
    return SimpleNamespace(**pickle.loads(kept.read_bytes()))


# --- faults -----------------------------------------------------------------------------------------------------------


class Patch:
    """A fault made by hand: a sentence, perhaps a line `Words: ...` of files of tests, and a unified diff."""

    def __init__(self, path):
        self.name, self.path = path.stem, path
        head = path.read_text().partition("\n--- ")[0].splitlines()
        self.sentence = head[0]
        self.words = " ".join(line[6:] for line in head if line.startswith("Words:")).split()

    def apply(self, tree):
        before = {file: (tree / file).read_text() for file in self._files() if (tree / file).exists()}
        outside = {**os.environ, "GIT_CEILING_DIRECTORIES": str(tree.parent)}
        done = subprocess.run(["git", "apply", str(self.path)], cwd=tree, env=outside, capture_output=True, text=True)
        if done.returncode != 0:
            raise DoesNotApply(f"{self.name} does not apply any more: {done.stderr.strip()}")
        return before

    def _files(self):
        return re.findall(r"^--- a/(\S+)", self.path.read_text(), re.MULTILINE)


class Mutant:
    """A sampled change of one line, found again by its text."""

    def __init__(self, entry):
        self.name, self.entry, self.words = entry["name"], entry, []
        self.sentence = f"{Path(entry['file']).name}: {entry['was']}  ->  {entry['now']}"
        self.equivalent = entry.get("equivalent", "")

    def apply(self, tree):
        file, was = self.entry["file"], self.entry["was"]
        if not (tree / file).exists() or was not in map(str.strip, (tree / file).read_text().splitlines()):
            moved = [p for s in hook.PACKAGES for p in (tree / s).rglob("*.py") if _lines_of(p).count(was) == 1]
            if len(moved) != 1:
                raise DoesNotApply(f"{self.name} does not apply any more: {file} has no line {was!r}")
            file = moved[0].relative_to(tree).as_posix()
        before = (tree / file).read_text()
        lines = before.splitlines(keepends=True)
        places = [n for n, line in enumerate(lines) if line.strip() == was]
        place = places[min(self.entry["nth"], len(places) - 1)]
        lines[place] = lines[place].replace(was, self.entry["now"])
        (tree / file).write_text("".join(lines))
        return {file: before}


def _lines_of(path):
    return [line.strip() for line in path.read_text().splitlines()]


def all_faults():
    patches = [Patch(path) for path in sorted(PATCHES.glob("*.patch"))]
    mutants = [Mutant(json.loads(line)) for line in MUTANTS.read_text().splitlines()]
    return [*patches, *(mutant for mutant in mutants if not mutant.equivalent)]


def changed_lines(before, after):
    """Numbers of the lines that changed, in the text before."""
    lines = set()
    matcher = difflib.SequenceMatcher(None, before.splitlines(), after.splitlines(), autojunk=False)
    for tag, first, last, _, _ in matcher.get_opcodes():
        if tag != "equal":
            lines.update(range(first + 1, max(last, first + 1) + 1))
    return lines


def candidates(fault, before, tree, reach):
    """Tests that reach what the fault changes; those of the file, or of its words, where no block holds it."""
    tests = set()
    for file, text in before.items():
        name = hook.name_of(file) or file
        found = hook.blocks(ast.parse(text)) if file.endswith(".py") else []
        for line in changed_lines(text, (tree / file).read_text()):
            holding = [block for block in found if block[0] <= line <= block[1]]
            if holding:
                tests |= reach.of_block[f"{name}:{min(holding, key=lambda b: b[1] - b[0])[0]}"]
            else:
                tests |= reach.in_file[name]
        if not tests:
            tests |= reach.in_file[name]
    words = set(fault.words) or (set() if tests else {Path(file).stem for file in before})
    return tests | {test for test in reach.durations if any(word in Path(test.split("::")[0]).stem for word in words)}


def ordered(tests, fault, before, reach, levels, seconds):
    """The order in which to run them: by level, those of the files that are most about it first, quick ones first."""
    stems = {word for file in before for word in Path(file).stem.split("_")} | set(fault.words)
    by_file = defaultdict(list)
    for test in tests:
        by_file[test.split("::")[0]].append(test)

    def about(file):
        own = set(Path(file).stem.split("_"))
        return 1.0 if own & set(fault.words) else len(stems & own) / len(stems)

    keyed = []
    for file, own in by_file.items():
        level = file.split("/")[1]
        for rank, test in enumerate(sorted(own, key=lambda test: (reach.durations[test], test))):
            keyed.append(
                (levels.index(level), rank // (40 if about(file) >= 0.5 else 4), -about(file), reach.size[file], test)
            )
    chosen, spent, counted = [], Counter(), Counter()
    for level, *_, test in sorted(keyed):
        if spent[level] < seconds and counted[level] < MOST_TESTS:
            chosen.append(test)
            spent[level] += reach.durations[test]
            counted[level] += 1
    return chosen


# --- one fault --------------------------------------------------------------------------------------------------------


class Trees:
    """Copies of the tree, one for each job; a changed file never has a time of change that it had before."""

    def __init__(self, suite, source, jobs):
        self._free = queue.Queue()
        self._clock, self._lock = int(time.time()), threading.Lock()
        for number in range(jobs):
            self._free.put(copy_tree(source, SCRATCH / suite / f"tree-{number}"))

    def measure(self, fault, reach, levels, seconds):
        tree = self._free.get()
        before = {}
        try:
            before = fault.apply(tree)
            self._touch(tree, before)
            return measured(fault, before, tree, reach, levels, seconds)
        except DoesNotApply as error:
            return {"error": str(error)}
        finally:
            for file, text in before.items():
                (tree / file).write_text(text)
            self._touch(tree, before)
            self._free.put(tree)

    def _touch(self, tree, files):
        with self._lock:
            self._clock += 2  # Python's cache of compiled code compares whole seconds
            for file in files:
                os.utime(tree / file, (self._clock, self._clock))


def measured(fault, before, tree, reach, levels, seconds):
    found = candidates(fault, before, tree, reach)
    order = ordered(found, fault, before, reach, levels, seconds)
    if not order:
        return {"survived": "no test reaches it"}
    # Most faults are found by the first files: the others need not be imported then.
    first = set(list(dict.fromkeys(test.split("::")[0] for test in order))[:FIRST_FILES])
    ran = 0
    for files_of in (first, {test.split("::")[0] for test in order} - first):
        tests = [test for test in order if test.split("::")[0] in files_of]
        while tests:
            facts = ended(tree, tests, seconds * len(levels), before)
            if "ran" in facts:
                ran += facts["ran"]
                break
            # What takes long may fail because the machine is busy: it has to fail twice.
            killer = facts.get("test")
            if reach.durations.get(killer, 0.0) < DOUBTFUL or "ran" not in ended(tree, [killer], seconds):
                return facts
            tests = tests[tests.index(killer) + 1 :]
    return {"survived": f"{ran} of {len(found)} tests that reach it"}


def ended(tree, tests, seconds, changed=()):
    """How a run of these tests in a changed tree ended: with an error, a failing test, or `ran` as many as passed."""
    picks, result, log = (tree / ".ws" / name for name in ("picks.json", "result.json", "pytest.log"))
    result.unlink(missing_ok=True)
    limit = 3.0 * seconds
    picks.write_text(json.dumps({"tests": tests, "result": str(result), "seconds": limit}))
    files = list(dict.fromkeys(test.split("::")[0] for test in tests))
    in_time = run_pytest(tree, ["-p", "no:cacheprovider", *files], log, limit + HANGS, FAULTS_PICKS=str(picks))
    if not result.exists():
        said = log.read_text()
        if any(file in said for file in changed):
            return {"level": files[0].split("/")[1], "test": files[0], "why": "it cannot be imported"}
        return {"error": "the tests did not begin: " + "".join(said.splitlines(True)[-3:])}
    facts = json.loads(result.read_text())
    killer = facts.get("killed") or facts.get("running")
    if not killer:
        return {"ran": facts["ran"]}
    why = facts.get("why") or ("it hung" if not in_time else "it ended its process")
    return {"level": killer.split("/")[1], "test": killer, "why": " ".join(why.split())[:100]}


# --- the record -------------------------------------------------------------------------------------------------------


def load_record():
    return json.loads(RECORD.read_text()) if RECORD.exists() else {"suites": {}, "faults": {}}


def save_record(record):
    """One line a fault, so that changes can be read."""
    known = {fault.name for fault in all_faults()}
    rows = [f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in sorted(record["faults"].items()) if k in known]
    text = '{"suites": ' + json.dumps(record["suites"]) + ',\n "faults": {\n' + ",\n".join(rows) + "\n}}\n"
    RECORD.write_text(text)


def table(record, faults, suites):
    """The record as text, and how many of each kind are killed."""
    lines = []
    for fault in faults:
        row = record["faults"].get(fault.name, {})
        lines.append(f"{fault.name}\n    {fault.sentence}")
        for suite in suites:
            said = row.get(suite, {})
            what = said.get("survived") and f"SURVIVED ({said['survived']})" or said.get("error")
            lines.append(f"    {suite}: {what or said.get('test', 'not measured')}")
    for suite in suites:
        for kind in (Patch, Mutant):
            rows = [record["faults"].get(fault.name, {}).get(suite) for fault in faults if isinstance(fault, kind)]
            rows = [row for row in rows if row]
            killed = Counter(row["level"] for row in rows if "test" in row)
            where = ", ".join(f"{count} {level}" for level, count in killed.items())
            lines.append(f"{suite}: {sum(killed.values())} of {len(rows)} {kind.__name__}es killed ({where})")
    return "\n".join(lines).replace("Mutantes", "sampled mutants").replace("Patches", "faults made by hand")


def sample(count, seed):
    """Draw the mutants anew, with packages in a place of their own."""
    python = SCRATCH / "venv" / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(SCRATCH / "venv")], check=True)
    wanted = str(ROOT / "setup" / "requirements-faults.lock")
    install = [str(python), "-m", "pip", "install", "--quiet", "--require-hashes", "--no-deps", "-r", wanted]
    subprocess.run(install, check=True)
    subprocess.run([str(python), str(HERE / "sample.py"), "--count", str(count), "--seed", str(seed)], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="faults to apply, by parts of their names; all without")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="how many faults at once")
    parser.add_argument("--only-survivors", action="store_true", help="those that survived, or were not measured")
    parser.add_argument(
        "--record-coverage", action="store_true", help="only run all tests once and see what they reach"
    )
    parser.add_argument("--suite", default="now", help="name of the column in the record")
    parser.add_argument("--tree", type=Path, default=ROOT, help="checkout with the tests, built; this one without")
    parser.add_argument("--levels", nargs="*", help=f"folders of test/; {' '.join(USUAL)} without")
    parser.add_argument("--seconds", type=float, default=40.0, help="for the tests of one level against one fault")
    parser.add_argument("--table", action="store_true", help="only print the record")
    parser.add_argument("--check", action="store_true", help="only tell which faults do not apply any more")
    parser.add_argument("--sample", type=int, metavar="N", help="draw N mutants anew, then end")
    parser.add_argument("--seed", type=int, default=5, help="of the sample")
    asked = parser.parse_args()
    if asked.sample:
        sample(asked.sample, asked.seed)
        return 0
    source, suite = asked.tree.resolve(), asked.suite
    levels = asked.levels or [level for level in USUAL if any((source / "test" / level).rglob("test_*.py"))]
    record = load_record()
    faults = [f for f in all_faults() if not asked.names or any(name in f.name for name in asked.names)]
    if asked.only_survivors:
        faults = [f for f in faults if "test" not in record["faults"].get(f.name, {}).get(suite, {})]
    if asked.table:
        print(table(record, faults, record["suites"]))
        return 0
    if asked.check:
        trees, bad = copy_tree(source, SCRATCH / "check"), 0
        for fault in faults:
            try:
                for file, text in fault.apply(trees).items():
                    (trees / file).write_text(text)
            except DoesNotApply as error:
                print(error)
                bad += 1
        print(f"{len(faults) - bad} faults apply, {bad} do not")
        return bad > 0
    known = (SCRATCH / suite / "reach").exists()
    if asked.record_coverage or not known or not (asked.names or asked.only_survivors):
        record_reach(suite, source, levels, asked.jobs)
    if asked.record_coverage:
        return 0
    reach = load_reach(suite)
    record["suites"][suite] = {"tests": len(reach.durations), "levels": levels}
    trees, lock, began = Trees(suite, source, asked.jobs), threading.Lock(), time.monotonic()

    def work(fault):
        facts = trees.measure(fault, reach, levels, asked.seconds)
        with lock:
            record["faults"].setdefault(fault.name, {})[suite] = facts
            save_record(record)
            print(
                f"{fault.name}: {facts.get('test') or facts.get('error') or 'SURVIVED: ' + facts['survived']}",
                flush=True,
            )
        return "error" in facts

    with ThreadPoolExecutor(asked.jobs) as pool:
        errors = sum(pool.map(work, faults))
    text = table(load_record(), faults, [suite])
    (SCRATCH / suite / "table.txt").write_text(text)
    print(text.splitlines()[-2], text.splitlines()[-1], f"{time.monotonic() - began:.0f} s", sep="\n")
    return errors > 0


if __name__ == "__main__":
    sys.exit(main())
