"""The errors that end a run with one line on stderr."""


class RunStopped(Exception):
    """The run cannot go on; its results so far are kept, and the same command resumes it."""


class UsageError(Exception):
    """An option or argument cannot be used; exit status 2."""


class UnusableResults(Exception):
    """The results of a folder cannot be read, or their tables not written."""
