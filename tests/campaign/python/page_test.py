"""The Python of docs/python.md runs, block by block, in one program."""

import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

import fogline_lab as fl

SOURCES = pathlib.Path(os.environ["SOURCES"])


class PageTest(unittest.TestCase):
    def test_its_code_runs_in_the_order_of_the_page(self):
        page = (SOURCES / "docs" / "python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        self.assertGreaterEqual(len(blocks), 6)
        out = io.StringIO()
        names = {}
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(out):
            os.symlink(SOURCES / "scenario", pathlib.Path(folder, "scenario"))
            os.chdir(folder)
            # The blocks use a network of their own, so they do not follow another run of this
            # machine.
            port = 20_000 + os.getpid() % 9_000
            os.environ["LCM_DEFAULT_URL"] = f"udpm://239.255.76.67:{port}?ttl=0"
            for block in blocks:
                if "fl.serve(" not in block:  # PythonRoleTest runs this block
                    exec(compile(block, "docs/python.md", "exec"), names)
        text = out.getvalue()
        self.assertIn("29 ", text, "the last step of the live run")
        self.assertIn("0.8 ", text, "the threshold of the log")
        self.assertTrue(issubclass(names["Steady"], fl.Radar))
        self.assertEqual(len(names["log"].TRACK), 500)


if __name__ == "__main__":
    unittest.main()
