#!/usr/bin/env bash
# Builds the documents as a site for browsers, in build/site, with a reference of the public headers; links between pages are checked.
#   scripts/site.sh [--no-setup]        --no-setup: mkdocs and doxygen are there
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$project_root"

case "${1:-}" in
  -h | --help)
    sed -n '2,3s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  --no-setup) ;;
  '') ./scripts/setup.sh site ;;
  *)
    echo "site.sh: unknown option '$1'; see --help" >&2
    exit 2
    ;;
esac

# The pages, and what they link to, in folders as here.
pages=build/site-pages
rm -rf "$pages"
mkdir -p "$pages"
cp --parents README.md CHANGELOG.md CONTRIBUTING.md LICENSE CITATION.cff "$pages"
cp -r docs configs examples scripts "$pages"
doxygen docs/Doxyfile
mkdocs build --strict --clean --quiet
ls build/site/index.html build/site/api/index.html
