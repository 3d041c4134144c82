#!/usr/bin/env python3
"""The subject of a commit has at most 72 characters.

usage: check_subject.py MESSAGE_FILE
"""

import pathlib
import sys

MOST = 72


def subject_of(message):
    """Its first line that is neither empty nor a remark."""
    lines = (line.rstrip() for line in message.splitlines())
    return next((line for line in lines if line and not line.startswith("#")), "")


def problem_of(message):
    """What is wrong, or an empty text."""
    subject = subject_of(message)
    if len(subject) <= MOST:
        return ""
    return f"the subject has {len(subject)} characters, more than {MOST}; move details to the body: {subject}"


if __name__ == "__main__":
    sys.exit(problem_of(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")) or 0)
