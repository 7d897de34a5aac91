# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Helpers of these tests: a scratch tree of files, and the scripts in tools/ as modules."""

import importlib.machinery
import importlib.util
import sys
import tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent.parent


def load_script(path):
    """A Python script, with or without .py, as a module."""
    name = path.stem.replace("-", "_")
    sys.path.insert(0, str(path.parent))  # scripts import their neighbours
    try:
        loader = importlib.machinery.SourceFileLoader(name, str(path))
        spec = importlib.util.spec_from_loader(name, loader)
        module = importlib.util.module_from_spec(spec)
        sys.dont_write_bytecode, kept = True, sys.dont_write_bytecode
        try:
            loader.exec_module(module)
        finally:
            sys.dont_write_bytecode = kept
        return module
    finally:
        sys.path.pop(0)


def load_tool(name):
    tool = PROJECT / "tools" / name
    return load_script(tool if tool.exists() else tool.with_suffix(".py"))


class Tree:
    """A scratch folder with the files given as {path: text}, gone at the end of the `with` block."""

    def __init__(self, files):
        self.files = files

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="kinemark-")
        root = Path(self.folder.name)
        for path, text in self.files.items():
            file = root / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        return root

    def __exit__(self, *_):
        self.folder.cleanup()
