#!/usr/bin/env python3
"""Makes a wheel of the installed package, with what pyproject.toml says of it. Needs nothing but Python, and objdump for a name that
installers elsewhere accept.

usage: make_wheel.py PYPROJECT VERSION INSTALLED_FOLDER TARGET_FOLDER       prints the name of the wheel
"""

import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile

try:
    import tomllib
except ImportError:  # before Python 3.11
    import tomli as tomllib

EPOCH = (1980, 1, 1, 0, 0, 0)  # the same files make the same wheel

# What every Linux has, in the version of its C library; libgcc_s has not changed for long.
EVERYWHERE = re.compile(r"(libc|libm|libpthread|libdl|librt|libgcc_s|ld-linux[\w-]*)\.so\.\d+")


def least_glibc(modules):
    """The least version of the C library, as (2, 34), with which modules work on any Linux; None where they need more than that."""
    versions = {(2, 17)}
    for module in modules:
        needs = subprocess.run(["objdump", "-p", module], capture_output=True, text=True, check=True).stdout
        if not all(map(EVERYWHERE.fullmatch, re.findall(r"NEEDED\s+(\S+)", needs))):
            return None
        versions |= {tuple(map(int, version.split("."))) for version in re.findall(r"GLIBC_([\d.]+)", needs)}
    return max(versions)[:2]


def platform_of(modules):
    """manylinux_2_34_x86_64 for modules that need the C library alone; otherwise that of this machine: linux_x86_64."""
    here = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    if not here.startswith("linux_") or not modules or not shutil.which("objdump"):
        return here
    glibc = least_glibc(modules)
    return here.replace("linux", f"manylinux_{glibc[0]}_{glibc[1]}", 1) if glibc else here


def tag(modules):
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{platform_of(modules)}"


def metadata(project, version, readme):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"Requires-Python: {project['requires-python']}", "License-File: LICENSE"]
    lines += [f"Requires-Dist: {needed}" for needed in project["dependencies"]]
    for extra, wanted in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f"Requires-Dist: {needed} ; extra == '{extra}'" for needed in wanted)]
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


def metadata_of(source, version):
    """The metadata of the package, from the folder of its source."""
    project = tomllib.loads((source / "pyproject.toml").read_text())["project"]
    return metadata(project, version, (source / project["readme"]).read_text())


def record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}"


def write_wheel(path, files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)


def make_wheel(source, version, installed, target, licenses=()):
    """Writes the wheel of the package below `installed` into the folder `target`; `licenses`: of what it carries."""
    info = f"driftmesh-{version}.dist-info"
    paths = [path for path in sorted(installed.rglob("*")) if path.is_file()]
    files = {path.relative_to(installed).as_posix(): path.read_bytes() for path in paths}
    its_tag = tag([path for path in paths if ".so" in path.suffixes])
    files[f"{info}/LICENSE"] = (source / "LICENSE").read_bytes()
    for license_file in licenses:
        files[f"{info}/licenses/{license_file.name}"] = license_file.read_bytes()
    files[f"{info}/METADATA"] = metadata_of(source, version).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: driftmesh\nRoot-Is-Purelib: false\nTag: {its_tag}\n".encode()
    files[f"{info}/RECORD"] = "".join(f"{line}\n" for line in [*(record_line(n, c) for n, c in files.items()),
                                                              f"{info}/RECORD,,"]).encode()
    wheel = target / f"driftmesh-{version}-{its_tag}.whl"
    target.mkdir(parents=True, exist_ok=True)
    write_wheel(wheel, files)
    return wheel


def main():
    pyproject, version, installed, target = sys.argv[1:]
    print(make_wheel(pathlib.Path(pyproject).parent, version, pathlib.Path(installed), pathlib.Path(target)))


if __name__ == "__main__":
    main()
