#!/usr/bin/env python3
"""Tests of the rules on small samples."""

import tempfile
import unittest
from pathlib import Path

from imports import circles, imports
from modules import expanded
from rust_source import code, strings, without_tests


def sample(files):
    """The imports of a crate with these files: for each file the files that it imports; and every circle as a sorted list."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        edges = imports(root / "lib.rs")
        names = {file.relative_to(root).as_posix(): sorted(other.relative_to(root).as_posix() for other in others) for file, others in edges.items()}
        return names, [sorted(file.relative_to(root).as_posix() for file in circle) for circle in circles(edges)]


class Source(unittest.TestCase):
    def test_code_is_what_is_neither_comment_nor_literal(self):
        text = """let a: &'x str = "use b; // no"; // use c;\nlet d = r#"use "e";"#; let f = '"'; /* use g; */ let h = b'\\'';"""
        self.assertEqual(" ".join(code(text).split()), "let a: &'x str = ; let d = ; let f = ; let h = ;")

    def test_strings_keep_their_text_and_their_place(self):
        text = '// "a"\nlet b = "c \\" d"; let e = r"--f";'
        self.assertEqual(list(strings(text)), [(text.index('"c'), 'c \\" d'), (text.index('r"'), "--f")])

    def test_tests_are_left_out_and_lines_stay(self):
        text = "use a;\n#[cfg(test)]\n#[allow(x)]\nmod tests {\n  use b;\n}\n#[cfg(not(test))]\nuse c;\n#[cfg(all(test, unix))]\nuse d;\n"
        kept = without_tests(text)
        self.assertEqual([line for line in kept.splitlines() if line.strip()], ["use a;", "#[cfg(not(test))]", "use c;"])
        self.assertEqual(kept.count("\n"), text.count("\n"))


class Imports(unittest.TestCase):
    def test_use_trees_are_expanded(self):
        found = list(expanded("a::{b, c::{self, D as E}, f::*}"))
        self.assertEqual(found, [(("a", "b"), "b"), (("a", "c"), "c"), (("a", "c", "D"), "E"), (("a", "f"), "*")])

    def test_a_circle_of_two_files_is_found_and_a_line_is_none(self):
        files = {"lib.rs": "mod a; mod b; mod c;", "a.rs": "use crate::b::B;", "b.rs": "fn f() { super::a::g() }", "c.rs": "use crate::a::A;"}
        edges, found = sample(files)
        self.assertEqual(edges, {"a.rs": ["b.rs"], "b.rs": ["a.rs"], "c.rs": ["a.rs"]})
        self.assertEqual(found, [["a.rs", "b.rs"]])

    def test_a_parent_that_only_declares_and_passes_on_imports_nothing(self):
        files = {"lib.rs": "mod a;", "a/mod.rs": "mod b; pub use b::B; pub(crate) struct A;", "a/b.rs": "use super::A;"}
        edges, found = sample(files)
        self.assertEqual((edges, found), ({"a/b.rs": ["a/mod.rs"]}, []))

    def test_a_parent_that_uses_its_child_imports_it(self):
        for parent in ["mod b; use b::B; struct A(B);", "mod b; pub use b::B; struct A(B);", "mod b; struct A(b::B);", "mod b; use b::*; struct A;"]:
            _, found = sample({"lib.rs": "mod a;", "a/mod.rs": parent, "a/b.rs": "use super::A;"})
            self.assertEqual(found, [["a/b.rs", "a/mod.rs"]], parent)

    def test_a_re_export_is_the_file_that_it_comes_from(self):
        for passed_on in ["B", "*"]:
            files = {
                "lib.rs": "mod a; mod c; pub use a::B;",
                "a/mod.rs": f"mod b; pub use b::{passed_on};",
                "a/b.rs": "use crate::c::C; pub struct B;",
                "c.rs": "use crate::B; pub struct C;",
            }
            _, found = sample(files)
            self.assertEqual(found, [["a/b.rs", "c.rs"]], passed_on)

    def test_a_module_that_is_named_is_imported_by_what_is_taken_from_it(self):
        files = {"lib.rs": "mod a; mod b;", "a/mod.rs": "pub mod c; pub mod d;", "a/c.rs": "", "a/d.rs": "", "b.rs": "use crate::a; fn f() { a::c::g() }"}
        edges, _ = sample(files)
        self.assertEqual(edges, {"b.rs": ["a/c.rs"]})

    def test_other_crates_and_modules_within_a_file_are_no_imports(self):
        files = {"lib.rs": "mod a; mod b; use std::fmt;", "a.rs": "use std::fmt; use rand::b::X; mod inner { use super::Y; use crate::b::Z; } struct Y;", "b.rs": ""}
        edges, _ = sample(files)
        self.assertEqual(edges, {"a.rs": ["b.rs"]})

    def test_tests_are_no_imports(self):
        files = {"lib.rs": "mod a; mod b;", "a.rs": "use crate::b::B;", "b.rs": "#[cfg(test)]\nmod tests;\n#[cfg(test)]\nuse crate::a::A;", "b/tests.rs": "use crate::a::A;"}
        _, found = sample(files)
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main()
