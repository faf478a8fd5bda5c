"""What is wrong with a design, where, and how to fix it."""

from __future__ import annotations


class DesignError(ValueError):
    """A fault of a design.

    As a text it shows the place, what is wrong, the line with the place marked, and the fix; then
    the same of every further fault.

    Attributes
    ----------
    file : str
        The file's name, as it was given.
    line, column : int or None
        Where, counted from 1; None where the design as a whole is at fault.
    message : str
        What is wrong.
    mend : str
        How to fix it.
    also : tuple of DesignError
        What else is wrong, in the order of the file.
    """

    def __init__(self, text, file=None, line=None, column=None, message=None, mend=None, also=()):
        super().__init__(text)
        self.file = file
        self.line = line
        self.column = column
        self.message = text if message is None else message
        self.mend = mend
        self.also = tuple(also)

    def __reduce__(self):
        fields = (self.file, self.line, self.column, self.message, self.mend, self.also)
        return type(self), (self.args[0], *fields)
