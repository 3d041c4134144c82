"""A root with nothing but Python and numpy, put together from the files of those Debian packages that are installed here."""

import os
import pathlib
import re
import shutil
import subprocess

NO_NEED = {"debconf", "dpkg", "install-info", "media-types", "mime-support", "perl-base", "tar"}  # to install them, not to run them


def packages_needed(names):
    """These packages and all that they depend on, as installed here."""
    listed = subprocess.run(["dpkg-query", "-W", "-f", "${binary:Package}\t${Provides}\t${Pre-Depends}, ${Depends}\n"], capture_output=True,
                            text=True, check=True).stdout
    provider, depends = {}, {}
    for line in listed.splitlines():
        package, provides, needs = line.split("\t")
        name = package.split(":")[0]
        depends[package] = [[re.split(r"[ :(]", one.strip())[0] for one in either.split("|")] for either in needs.split(",") if either.strip()]
        for provided in [name, *(re.split(r"[ (]", one.strip())[0] for one in provides.split(",") if one.strip())]:
            provider.setdefault(provided, package)
        provider[name] = package
    found, waiting = set(), list(names)
    for name in waiting:
        package = provider.get(name)
        if package in found or name in NO_NEED or package is None:
            continue
        found.add(package)
        waiting += [next((one for one in either if one in provider), either[0]) for either in depends[package]]
    return found


def make_root(folder):
    """Copies them, with the links that the loader finds its libraries by."""
    for package in sorted(packages_needed(["python3", "python3-numpy"])):
        for name in subprocess.run(["dpkg", "-L", package], capture_output=True, text=True, check=True).stdout.splitlines():
            path = pathlib.Path(name)
            if not path.is_absolute() or name.startswith(("/usr/share/doc", "/usr/share/man", "/usr/share/locale")) or not os.path.lexists(name):
                continue
            target = pathlib.Path(f"{folder}{os.path.realpath(path.parent)}") / path.name
            if path.is_symlink() or path.is_file():
                target.parent.mkdir(parents=True, exist_ok=True)
                if not os.path.lexists(target):
                    shutil.copy2(path, target, follow_symlinks=False)
    for top in ("bin", "lib", "lib64", "sbin"):
        if os.path.islink(f"/{top}") and not os.path.lexists(f"{folder}/{top}"):
            os.symlink(os.readlink(f"/{top}"), f"{folder}/{top}")


def environment(folder):
    """For what runs there: the alternatives of Debian, such as of BLAS, are not set up."""
    libraries = [f"/{path.relative_to(folder)}" for kind in ("blas", "lapack") for path in folder.glob(f"usr/lib/*/{kind}")]
    return {"PATH": "/usr/bin", "LC_ALL": "C.UTF-8", "LD_LIBRARY_PATH": ":".join(libraries)}
