"""The installed kernels, from outside: python3 package_test.py CMAKE BUILD [options of CMake]

BUILD is the folder to install from; of what it builds, only the libraries of the kernels are needed.
The options configure tests/consumer.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CMAKE, BUILD, *OPTIONS = sys.argv[1:]
ROOT = pathlib.Path(__file__).resolve().parent.parent
CONSUMER = ROOT / "tests/consumer"
LIBRARIES = {"lib/libdefinite_kernels.a", "lib/libdefinite_assembly.a"}
PACKAGE = "lib/cmake/definite/"
TIMEOUT = 300  # seconds; a sanitizer may be slow


def run(*words):
    return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=TIMEOUT, check=False)


def output(*words):
    """What a command that ends well prints."""
    done = run(*words)
    if done.returncode != 0:
        raise AssertionError(f"exit {done.returncode}: {done.stdout}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.prefix = cls.folder / "prefix"
        output(CMAKE, "--install", BUILD, "--prefix", cls.prefix, "--component", "kernels")
        cls.files = {str(path.relative_to(cls.prefix)): path for path in cls.prefix.rglob("*")
                     if path.is_file()}
        cls.configure = (CMAKE, "-S", CONSUMER, f"-DCMAKE_PREFIX_PATH={cls.prefix}", *OPTIONS)

    def test_a_consumer_builds_filters_in_two_ways_and_assembles(self):
        build = self.folder / "consumer"
        output(*self.configure, "-B", build)
        output(CMAKE, "--build", build)
        printed = output(build / "filter_contacts")
        found = re.fullmatch(r"8 contacts: trace of the filtered Hessians (\S+), "
                             r"0 entries differ\n", printed)
        self.assertTrue(found, printed)
        self.assertGreater(float(found[1]), 0)
        self.assertEqual(output(build / "assemble_contacts"),
                         "2 contacts in 2 colours, 17 blocks: translations cost nothing\n")

    def test_it_holds_every_header_of_the_kernels_and_nothing_that_a_consumer_does_not_need(self):
        headers = {f"include/definite/{path.relative_to(ROOT)}"
                   for path in (ROOT / "kernels").rglob("*.hpp")}
        files = {re.sub(r"Targets-\w+", "Targets-BUILD_TYPE", name) for name in self.files}
        self.assertEqual(files, headers | LIBRARIES | {PACKAGE + name for name in (
            "FindOpenBLAS.cmake", "FindSLEEF.cmake", "definiteConfig.cmake", "definiteConfigVersion.cmake",
            "definiteTargets.cmake", "definiteTargets-BUILD_TYPE.cmake")})

    def test_no_file_mentions_the_sources_or_the_build(self):
        for name, path in self.files.items():
            if name not in LIBRARIES:  # whose debugging information names its sources
                for place in (str(ROOT), BUILD):
                    self.assertNotIn(place, path.read_text(), name)

    def test_what_the_bits_hang_on_travels_and_warnings_do_not(self):
        targets = self.files[PACKAGE + "definiteTargets.cmake"].read_text()
        for option in ("-march=", "-ffp-contract=off", "-fno-math-errno", "cxx_std_20"):
            self.assertIn(option, targets)
        self.assertNotRegex(targets, "-W|Eigen")

    def test_without_sleef_it_says_what_is_missing(self):
        done = run(*self.configure, "-B", self.folder / "without_sleef",
                   f"-DCMAKE_FIND_ROOT_PATH={self.prefix}",  # headers and libraries only there
                   "-DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY",
                   "-DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY")
        self.assertNotEqual(done.returncode, 0)
        said = " ".join(done.stdout.split())  # CMake wraps lines
        self.assertIn("install SLEEF (libsleef-dev on Debian)", said)

    def test_the_readme_quotes_the_consumer(self):
        section = (ROOT / "README.md").read_text().split("## Use a filter in your solver\n")[1]
        for block, name in ((1, "main.cpp"), (2, "assemble.cpp")):
            lines = [line.strip() for line in (CONSUMER / name).read_text().splitlines()]
            quoted = section.split("```cpp\n")[block].split("```")[0].splitlines()
            self.assertTrue(quoted)
            for line in quoted:
                self.assertIn(line.strip(), lines)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
