"""All tables and charts as one page for browsers, which needs no other file; it links the pages of the experiments."""

import html

STYLE = """
body { font: 15px/1.5 sans-serif; color: #222; max-width: 75rem; margin: 2rem auto; padding: 0 1rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
.published { background: #eef3fa; }
svg { max-width: 40rem; width: 100%; display: block; }
@media print { section { break-inside: avoid; } }
"""


def is_published(words):
    return "published" in words


def cell(tag, words, published, more=""):
    kind = ' class="published"' if published else ""
    return f"<{tag}{more}{kind}>{html.escape(words)}</{tag}>"


def table_of(table):
    columns = [is_published(column) for column in table.columns]
    head = "".join(cell("th", column, there, ' scope="col"') for column, there in zip(table.columns, columns))
    body = []
    for row in table.rows:
        whole = any(map(is_published, row))
        body.append("".join(cell("td", words, whole or there) for words, there in zip(row, columns)))
    lines = "".join(f"<tr>{line}</tr>\n" for line in body)
    return f'<div class="wide"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{lines}</tbody></table></div>'


def section(folder, table):
    chart = folder / f"{table.name}.svg"
    picture = chart.read_text() if chart.exists() else ""
    return (f'<section id="{table.name}"><h2>{html.escape(table.title)}</h2>\n{table_of(table)}\n{picture}'
            f"<p>{html.escape(table.notes)}</p></section>\n")


def links(folder):
    pages = sorted(folder.glob("report-*.html"))
    if not pages:
        return ""
    items = "".join(f'<li><a href="{page.name}">{page.stem.removeprefix("report-")}</a></li>' for page in pages)
    return f"<h2>The runs, one page for each experiment</h2><ul>{items}</ul>\n"


def write(folder, caution, tables):
    contents = "".join(f'<li><a href="#{table.name}">{html.escape(table.title)}</a></li>' for table in tables)
    text = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>The paper and driftmesh</title>\n'
            f"<style>{STYLE}</style></head>\n<body><h1>The paper and driftmesh</h1>\n<p>{html.escape(caution)}Published values "
            f'have a <span class="published">tinted ground</span>, and dashed lines in charts.</p>\n<ul>{contents}</ul>\n'
            f"{''.join(section(folder, table) for table in tables)}{links(folder)}</body></html>\n")
    (folder / "paper.html").write_text(text)
