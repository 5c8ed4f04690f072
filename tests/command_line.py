"""What the command line is about to print of mistakes and warnings: the records, not their words."""

from unittest import mock

from typer.testing import CliRunner

from thirdbody import cli
from thirdbody.cli import streams
from thirdbody.errors import Mistake


class Done:
    """What a command left behind: its streams and exit status, its mistakes and its warnings.

    Each record of these has been printed as a sentence, which is checked where it is made.
    """

    def __init__(self, result, problems, notes, remarks):
        self.result, self.problems, self.notes = result, tuple(problems), tuple(notes)
        self.remarks = tuple(remarks)

    def __getattr__(self, name):
        return getattr(self.result, name)

    @property
    def mistakes(self):
        """Kind and dotted place of each mistake."""
        return [(each.code, each.place) for each in self.problems]

    @property
    def codes(self):
        """Codes of the warnings, in the order in which they are printed."""
        return [getattr(note, "code", "") for note in self.notes]

    def note(self, code):
        """The one warning with this code."""
        (note,) = (each for each in self.notes if getattr(each, "code", "") == code)
        return note


def run(*arguments):
    """The command line, in this process."""
    problems, notes, remarks = [], [], []
    complain, note_of, wrap = streams.complain, streams.note_of, streams._wrap_line

    def complained(sentences):
        sentences = list(sentences)
        problems.extend(sentences)
        complain(sentences)

    def warned(message):
        notes.append(note_of(message))
        return notes[-1]

    def wrapped(line):
        if line.startswith("note: "):
            remarks.append(line.removeprefix("note: "))
        return wrap(line)

    with (
        mock.patch.object(streams, "complain", complained),
        mock.patch.object(streams, "note_of", warned),
        mock.patch.object(streams, "_wrap_line", wrapped),
    ):
        result = CliRunner().invoke(cli.app, [str(argument) for argument in arguments])
    return Done(result, problems, notes, remarks)


def refused(*arguments):
    """A command that ends with status 2 for mistakes, each of which is printed."""
    done = run(*arguments)
    assert done.exit_code == 2, done.stdout
    assert "Traceback" not in done.stderr
    assert done.stderr.count("error: ") >= len(done.problems) > 0
    assert Mistake.UNSAID not in {each.code for each in done.problems}
    return done
