"""The notebook of the paper's experiment runs in Jupyter, with figures and the known digest."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

NOTEBOOK = pathlib.Path(os.environ["SOURCES"], "tools", "python", "examples", "paper.ipynb")
DIGEST = "90ca471057e464abfe9d7ecdf77847b16f1ad324c53bc77693fede234c4e8fd6"


class NotebookTest(unittest.TestCase):
    def test_it_runs_from_its_first_cell_to_its_last(self):
        with tempfile.TemporaryDirectory() as folder:
            command = ["/usr/bin/jupyter-nbconvert", "--to", "notebook", "--execute",
                       "--output-dir", folder, "--output", "run", str(NOTEBOOK)]
            # The kernel of Jupyter writes its port and its files below the home folder, so HOME is
            # a temporary folder.
            environment = {**os.environ, "HOME": folder, "LCM_DEFAULT_URL": "",
                           "PATH": "/usr/bin:/bin"}
            done = subprocess.run(command, env=environment, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            notebook = json.loads(pathlib.Path(folder, "run.ipynb").read_text())
        outputs = [output for cell in notebook["cells"] for output in cell.get("outputs", [])]
        pictures = [one for one in outputs if "image/png" in one.get("data", {})]
        text = "".join("".join(one.get("text", "")) for one in outputs)
        self.assertEqual(len(pictures), 4)
        self.assertIn(DIGEST, text)
        self.assertIn("with traded control: 2.8 mm on average in fog", text)

    def test_it_is_kept_without_outputs(self):
        cells = json.loads(NOTEBOOK.read_text())["cells"]
        self.assertFalse(any(cell.get("outputs") for cell in cells))


if __name__ == "__main__":
    unittest.main()
