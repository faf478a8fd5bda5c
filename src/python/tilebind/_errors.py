"""What is wrong with a design, where, and how to fix it."""

from __future__ import annotations


class DesignError(ValueError):
    """A mistake in a design.

    As a string it shows the place, what is wrong, the marked line and the fix, for
    every mistake.

    Attributes
    ----------
    file : str
        The file name as given.
    line, column : int or None
        The place, counted from 1; None if the design as a whole is wrong.
    message : str
        What is wrong.
    fix : str
        How to fix it.
    also : tuple of DesignError
        Further mistakes, in the order of the file.
    """

    def __init__(self, text, file=None, line=None, column=None, message=None, fix=None, also=()):
        super().__init__(text)
        self.file = file
        self.line = line
        self.column = column
        self.message = text if message is None else message
        self.fix = fix
        self.also = tuple(also)

    def __reduce__(self):
        fields = (self.file, self.line, self.column, self.message, self.fix, self.also)
        return type(self), (self.args[0], *fields)

    @property
    def mend(self):
        """The earlier name of `fix`."""
        return self.fix
