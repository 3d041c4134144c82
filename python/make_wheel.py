#!/usr/bin/env python3
"""Makes a wheel of the installed package, with what pyproject.toml says of it. Needs nothing but Python.

usage: make_wheel.py PYPROJECT VERSION INSTALLED_FOLDER TARGET_FOLDER       prints the name of the wheel
"""

import base64
import hashlib
import pathlib
import sys
import sysconfig
import tomllib
import zipfile

EPOCH = (1980, 1, 1, 0, 0, 0)  # the same files make the same wheel


def tag():
    """Of this Python: cp311-cp311-linux_x86_64."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")


def metadata(project, version, readme):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"Requires-Python: {project['requires-python']}", "License-File: LICENSE"]
    lines += [f"Requires-Dist: {needed}" for needed in project["dependencies"]]
    for extra, wanted in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f"Requires-Dist: {needed} ; extra == '{extra}'" for needed in wanted)]
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", readme])


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


def main():
    pyproject, version, installed, target = sys.argv[1:]
    source = pathlib.Path(pyproject).parent
    project = tomllib.loads(pathlib.Path(pyproject).read_text())["project"]
    folder = pathlib.Path(installed)
    info = f"{project['name']}-{version}.dist-info"
    files = {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
    files[f"{info}/LICENSE"] = (source / project["license"]["file"]).read_bytes()
    files[f"{info}/METADATA"] = metadata(project, version, (source / project["readme"]).read_text()).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: driftmesh\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode()
    files[f"{info}/RECORD"] = "".join(f"{line}\n" for line in [*(record_line(n, c) for n, c in files.items()),
                                                              f"{info}/RECORD,,"]).encode()
    wheel = pathlib.Path(target) / f"{project['name']}-{version}-{tag()}.whl"
    wheel.parent.mkdir(parents=True, exist_ok=True)
    write_wheel(wheel, files)
    print(wheel)


if __name__ == "__main__":
    main()
