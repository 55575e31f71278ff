"""The commands of the command line, one module each: ``harness NAME`` is what ``NAME.py`` of this package holds.

A module has ``SHORT`` (its line in the list of commands), ``DESCRIPTION`` (its help, with examples), ``add_arguments``
(gets its argparse parser) and ``run`` (gets the parsed options, may return an exit code; HarnessError where the input
is at fault). It imports what is slow to import in ``run``: the other commands do not pay for it. It runs in a worker
with a limit on memory and, unless it says ``TIME_LIMIT = None``, on time; ``IN_WORKER = False`` says that it runs in
the process itself, because what it starts keeps limits of its own.
Modules whose names begin with _ are no commands.
"""
