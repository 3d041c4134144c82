"""A table of a few columns, as Markdown and as CSV."""

import csv


def percent(part):
    return f"{100 * part:.1f} %"


class Table:
    def __init__(self, name, title, columns, notes, rows=()):
        self.name, self.title, self.columns, self.notes = name, title, columns, notes
        self.rows = []
        for row in rows:
            self.add(*row)

    def add(self, *cells):
        if len(cells) != len(self.columns):
            raise ValueError(f"{self.name}: {len(cells)} cells for {len(self.columns)} columns: {cells}")
        self.rows.append([cell if isinstance(cell, str) else f"{cell:,}" for cell in cells])

    def lines(self):
        """As Markdown, without title and notes."""
        return [f"| {' | '.join(line)} |" for line in [self.columns, ["---"] * len(self.columns), *self.rows]]

    def markdown(self):
        return "\n".join([f"## {self.title}", "", *self.lines(), "", *([self.notes, ""] if self.notes else [])])

    def write(self, folder):
        (folder / f"{self.name}.md").write_text(self.markdown())
        with open(folder / f"{self.name}.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(self.columns)
            writer.writerows([cell.replace(",", "") for cell in row] for row in self.rows)
