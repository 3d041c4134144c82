#!/usr/bin/env python3
"""check_words.py finds messages in the words of another door, and doors that edit messages.

usage: check_words_test.py [unittest options]
"""

import pathlib
import tempfile
import unittest

import check_words

TABLE = 'key("bounds.area", &R::bounds, "Largest area", option("area")), choice("run.order", 1),'


class CheckWords(unittest.TestCase):
    def found(self, **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {check_words.TABLE: TABLE, **files}.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_words.problems(folder)

    def test_keys_are_right(self):
        self.assertEqual(self.found(**{"src/job/a.cpp": 'say("remove {bounds.area} or {run.order}, {balance.own}");'}), [])
        self.assertEqual(self.found(**{"src/job/a.cpp": '// "--area"\nsay("{} -- {:.3g}");'}), [])
        self.assertEqual(self.found(**{"src/app/a.cpp": 'say("--area is missing"); table.erase(x);'}), [])
        self.assertEqual(self.found(**{"src/api/a.cpp": 'constexpr const char* kOwner = "MeshOptions::";'}), [])

    def test_others_are_found(self):
        for name, text, says in [("src/job/a.cpp", 'say("remove {bounds.arae}");', "no key 'bounds.arae'"),
                                 ("src/mesh/a.hpp", 'say("allow it with --area");', "words of the command line"),
                                 ("python/a.cpp", 'say("--area");', "words of the command line"),
                                 ("src/job/a.cpp", 'say("MeshOptions::max_area is");', "words of the library"),
                                 ("python/a.cpp", 'say("MeshOptions::max_area is");', "words of the library"),
                                 ("python/a.cpp", "message.erase(at, 5);", "edits a finished text"),
                                 ("src/api/a.cpp", "replace_word(text_of(error.what()), key);", "edits a finished text"),
                                 ("src/app/a.cpp", "std::string(e.what()).replace(1, 2, x);", "edits a finished text")]:
            found = self.found(**{name: text})
            self.assertEqual(len(found), 1, (text, found))
            self.assertIn(says, found[0])


if __name__ == "__main__":
    unittest.main()
