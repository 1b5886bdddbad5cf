"""A short hunt over all rows and families: none breaks a promise, and no case ends a process."""

import subprocess
import sys
import unittest

DEFINITE = sys.argv[1]


class Hunt(unittest.TestCase):
    def test_no_row_breaks_a_promise(self):
        done = subprocess.run([DEFINITE, "fuzz", "--quick"], capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("configurations in", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
