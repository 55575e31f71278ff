"""The commands of the command line, one module each: ``harness NAME`` is what ``NAME.py`` of this package holds.

A module has ``SHORT`` (its line in the list of commands), ``DESCRIPTION`` (its help, with examples), ``add_arguments``
(gets its argparse parser) and ``run`` (gets the parsed options, may return an exit code; HarnessError where the input
is at fault). It imports what is slow to import in ``run``: the other commands do not pay for it. ``TIME_LIMIT = None``
says that it runs in the process itself, with no limit, because it starts workers of its own; else it runs in a worker.
Modules whose names begin with _ are no commands.
"""
