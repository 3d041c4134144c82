"""Builds the package for pip (PEP 517), by CMake: `pip install .`, and from an sdist. Needs nothing but Python.

Settings (pip's -C, or --config-setting):
  define=NAME=VALUE    an option of CMake, such as define=DRIFTMESH_MPI=ON; several with ";" between them
  licenses=FOLDER      a folder of license files, of what the wheel carries
Without settings the package has the parts whose libraries are there, and none that needs MPI.
"""

import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python"))
import make_wheel  # noqa: E402

# What a build of the package takes of the project.
IN_SDIST = ("CHANGELOG.md", "CITATION.cff", "CMakeLists.txt", "LICENSE", "README.md", "pyproject.toml", "balancer", "cmake", "docs/python.md",
            "include", "migration", "protocol", "python", "src")
PARTS = ("CAIRO", "HDF5", "JSON", "METIS", "ZLIB")


def version():
    header = (SOURCE / "include/driftmesh/version.hpp").read_text()
    return ".".join(re.search(rf"DRIFTMESH_VERSION_{part} (\d+)", header).group(1) for part in ("MAJOR", "MINOR", "PATCH"))


def settings_of(given, name):
    values = (given or {}).get(name, [])
    return [value for text in ([values] if isinstance(values, str) else values) for value in text.split(";")]


def run(*command):
    print("+", *command, flush=True)
    subprocess.run([str(word) for word in command], check=True)


def has_pybind11():
    """Whether CMake finds it where packages of systems put it, without pip's help."""
    prefixes = [*os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep), "/usr", "/usr/local", "/opt/homebrew", sys.base_prefix]
    return any(list(pathlib.Path(prefix).glob("*/cmake/pybind11/pybind11Config.cmake")) for prefix in prefixes if prefix)


def get_requires_for_build_wheel(config_settings=None):
    needs = [] if has_pybind11() else ["pybind11>=2.10"]
    return needs + [program for program in ("cmake>=3.25", "ninja") if not shutil.which(program.split(">")[0])]


def get_requires_for_build_sdist(config_settings=None):
    return []


def place_of_pybind11():
    """Options that lead CMake to the pybind11 that pip installed, if it did."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / f"driftmesh-{version()}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(make_wheel.metadata_of(SOURCE, version()))
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    defined = settings_of(config_settings, "define")
    names = {definition.partition("=")[0] for definition in defined}
    defined += [f"DRIFTMESH_{part}=AUTO" for part in PARTS if f"DRIFTMESH_{part}" not in names]
    licenses = [path for folder in settings_of(config_settings, "licenses") for path in sorted(pathlib.Path(folder).iterdir())]
    build = SOURCE / "build" / f"wheel-{sys.implementation.cache_tag}"  # a second build takes up what is there
    with tempfile.TemporaryDirectory() as folder:
        installed = pathlib.Path(folder) / "installed"
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        run("cmake", "--fresh", *generator, "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DDRIFTMESH_MINIMAL=ON", "-DDRIFTMESH_TESTS=OFF",
            "-DDRIFTMESH_PYTHON=ON", "-DDRIFTMESH_PYTHON_DIR=.", f"-DPython_EXECUTABLE={sys.executable}", f"-DPython_ROOT_DIR={sys.base_prefix}",
            f"-DPython_INCLUDE_DIR={sysconfig.get_path('include')}", *place_of_pybind11(), *(f"-D{definition}" for definition in defined))
        run("cmake", "--build", build, "--config", "Release", "--target", "driftmesh_python_package", "--parallel", os.environ.get("JOBS", str(os.cpu_count())))
        run("cmake", "--install", build, "--config", "Release", "--component", "python", "--prefix", installed, "--strip")
        return make_wheel.make_wheel(SOURCE, version(), installed, pathlib.Path(wheel_directory), licenses).name


def is_made(path):
    return "__pycache__" in path.parts or path.suffix == ".pyc"


def build_sdist(sdist_directory, config_settings=None):
    name = f"driftmesh-{version()}"
    target = pathlib.Path(sdist_directory) / f"{name}.tar.gz"
    with tarfile.open(target, "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for top in IN_SDIST:
            for path in sorted([SOURCE / top] if (SOURCE / top).is_file() else (SOURCE / top).rglob("*")):
                if path.is_file() and not is_made(path):
                    archive.add(path, f"{name}/{path.relative_to(SOURCE).as_posix()}")
        content = make_wheel.metadata_of(SOURCE, version()).encode()
        entry = tarfile.TarInfo(f"{name}/PKG-INFO")
        entry.size = len(content)
        archive.addfile(entry, io.BytesIO(content))
    return target.name
