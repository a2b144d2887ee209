"""python -m imugui: the window, or one of the commands that need none."""

from __future__ import annotations

import sys

from imugui import cli


def main(argv: list[str] | None = None) -> int:
    """Run the program; returns its exit status."""
    arguments = cli.parser().parse_args(sys.argv[1:] if argv is None else argv)
    try:
        if arguments.command:
            return int(arguments.run(arguments))
        from imugui import app  # imported when used: the other commands need no window and start sooner

        return app.run_window(arguments)
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
