"""The commands `ptp-symbolic` and `regenerate-equations`."""

from ptp_symbolic.cli.interruption import interruptible


def main() -> None:
    """Entry point of `ptp-symbolic`."""
    with interruptible():
        from ptp_symbolic.cli.commands import commands, run

        run(commands)


def regenerate_main() -> None:
    """Entry point of `regenerate-equations`."""
    with interruptible():
        from ptp_symbolic.cli.commands import regenerate, run

        run(regenerate)
