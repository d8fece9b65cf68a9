"""What a scene file cannot say: one line each, and nothing twice."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Line:
    where: str
    """The object, material, node or setting."""
    what: str
    """What it has that cannot be said."""
    instead: str
    """What was done instead."""

    def __str__(self):
        return f"{self.where}: {self.what}; {self.instead}"


class Report:
    """Collects lines in the order in which they were found."""

    def __init__(self):
        self.lines = []

    def add(self, where, what, instead):
        line = Line(str(where), what, instead)
        if line not in self.lines:
            self.lines.append(line)

    def __str__(self):
        if not self.lines:
            return "everything was said"
        return "\n".join(str(line) for line in self.lines)
