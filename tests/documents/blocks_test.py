#!/usr/bin/env python3
"""What commands_test.py takes from a page: commands, files, conditions; and that no page has blocks that it does not know.

usage: blocks_test.py PROJECT_FOLDER
"""

import pathlib
import re
import sys
import unittest

from commands_test import REMARKS, Block, blocks_of

PROJECT = pathlib.Path(sys.argv.pop(1))
DRAWINGS = {"architecture.md"}  # indented blocks are diagrams


class Blocks(unittest.TestCase):
    def test_commands_are_indented_or_fenced(self):
        page = "Text\n\n    one\n\n    two\n\n- a list\n\n  goes on\n\n```sh\nthree\n```\n\n```cpp\nint main() {}\n```\n"
        self.assertEqual(blocks_of(page), ([Block("one\n\ntwo\n\n"), Block("three\n")], 0))

    def test_a_paragraph_that_goes_on_is_no_command(self):
        self.assertEqual(blocks_of("- a list\n    that goes on\n"), ([], 0))

    def test_remarks_are_about_the_next_block(self):
        page = ("<!-- not run: builds -->\n\n    make\n\n    make test\n\nText\n\n    one\n\n<!-- if: true -->\n<!-- small: 50M -> 5k; /shared/ -> -->\n\n"
                "    two 50M /shared/x 50M\n\n<!-- file: a/b.yaml -->\n```yaml\nkey: 1\n```\n<!-- before: make ready -->\n")
        self.assertEqual(blocks_of(page), ([Block("one\n\n"), Block("two 5k x 5k\n\n", condition="true"), Block("key: 1\n", file="a/b.yaml"),
                                            Block("make ready\n")], 1))

    def test_a_remark_ends_where_text_begins(self):
        self.assertEqual(blocks_of("<!-- not run: why -->\n\nText\n\n    one\n"), ([Block("one\n\n")], 0))

    def test_what_is_to_be_made_small_must_be_there(self):
        with self.assertRaisesRegex(ValueError, "50M"):
            blocks_of("<!-- small: 50M -> 5k -->\n\n    mesh 40M\n")

    def test_every_page_is_known(self):
        """A remark is one of those that are understood, and every page with commands is among the tests."""
        pages = [*PROJECT.glob("docs/**/*.md"), PROJECT / "README.md", PROJECT / "CONTRIBUTING.md"]
        self.assertGreater(len(pages), 15)
        for page in pages:
            with self.subTest(page=page.name):
                text = page.read_text()
                if page.name not in DRAWINGS:
                    blocks_of(text)
                for word in re.findall(r"^<!-- ([a-z ]+): ", text, re.MULTILINE):
                    self.assertIn(word, (*REMARKS, "needs", "keys", "table"))


if __name__ == "__main__":
    unittest.main()
