"""Writes down which blocks of the product each test reaches, in every process that it starts.

A line tracer (coverage.py) sees no call that libqi makes from a thread of its own, and those are what a robot's server
lives on. So the blocks themselves report: code of the product is compiled with a call at the begin of each.
"""

from __future__ import annotations

import ast
import builtins
import hashlib
import marshal
import mmap
import os
import sys
from importlib.machinery import SourceFileLoader

PACKAGES = ("nao_library_modules/src/", "nao_sim_bridge/src/")
COMPOUND = (ast.If, ast.For, ast.While, ast.Try, ast.With)
PAGE = 4096


def blocks(tree, change=""):
    """First and last line of each block within a function; with `change`, a file's name, they report themselves."""
    found = []

    def suite(statements, begin):
        if _docstring(statements) and len(statements) == 1:
            return
        starts = [int(_docstring(statements))] + [
            n + 1 for n, s in enumerate(statements[:-1]) if isinstance(s, COMPOUND)
        ]
        for position, start in enumerate(starts):
            stop = starts[position + 1] if position + 1 < len(starts) else len(statements)
            first = begin if position == 0 else statements[start].lineno
            found.append((first, statements[stop - 1].end_lineno))
        for statement in statements:
            parts(statement)
        if change:
            for position in reversed(range(len(starts))):
                first = begin if position == 0 else statements[starts[position]].lineno
                call = ast.Call(ast.Name("__reached__", ast.Load()), [ast.Constant(f"{change}:{first}")], [])
                probe = ast.copy_location(ast.Expr(call), statements[starts[position]])
                statements.insert(starts[position], ast.fix_missing_locations(probe))

    def parts(node):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            suite(node.body, min([node.lineno, *(d.lineno for d in node.decorator_list)]))
        elif isinstance(node, ast.ClassDef):
            for child in node.body:
                parts(child)
        elif isinstance(node, COMPOUND):
            suites = [getattr(node, name, None) for name in ("body", "orelse", "finalbody")]
            for statements in [*suites, *(handler.body for handler in getattr(node, "handlers", []))]:
                if statements:
                    suite(statements, statements[0].lineno)

    for statement in tree.body:
        if not isinstance(statement, COMPOUND):
            parts(statement)
    return found


def _docstring(statements):
    first = statements[0]
    return isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str)


def name_of(path):
    """`nao_sim_bridge/body/leds.py` for a file of the product, else None."""
    for package in PACKAGES:
        if package in path:
            return path.rpartition(package)[2]
    return None


class Child:
    """Reports to the process of the tests: what is reached for the first time since the test began."""

    def __init__(self, folder, page):
        self.page, self.folder, self.generation, self.seen, self.file = page, folder, b"", set(), None

    def __call__(self, name):
        generation = self.page[:8]
        if generation != self.generation:
            self.generation, self.seen = generation, set()
            self.test = self.page[8:].rstrip(b"\0").decode()
        if name not in self.seen:
            self.seen.add(name)
            if self.file is None or self.pid != os.getpid():
                self.pid = os.getpid()
                self.file = os.open(f"{self.folder}/child-{self.pid}.txt", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            os.write(self.file, f"{self.test}\t{name}\n".encode())


def install(folder):
    original = SourceFileLoader.get_code

    def get_code(self, fullname):
        path = os.path.realpath(self.get_filename(fullname))
        name = name_of(path)
        if name is None:
            return original(self, fullname)
        source = self.get_data(path)
        cached = f"{folder}/cache/{hashlib.sha1(path.encode() + source).hexdigest()}"
        try:
            with open(cached, "rb") as file:
                return marshal.loads(file.read())
        except (OSError, ValueError, EOFError):
            tree = ast.parse(source)
            blocks(tree, change=name)
            code = compile(tree, path, "exec", dont_inherit=True)
            with open(f"{cached}.{os.getpid()}", "wb") as file:
                file.write(marshal.dumps(code))
            os.replace(f"{cached}.{os.getpid()}", cached)
            return code

    SourceFileLoader.get_code = get_code
    page = os.environ.get("FAULTS_PAGE")
    if page:
        with open(page, "r+b") as file:
            builtins.__reached__ = Child(folder, mmap.mmap(file.fileno(), PAGE))
    else:
        sys.reached = set()
        builtins.__reached__ = sys.reached.add
