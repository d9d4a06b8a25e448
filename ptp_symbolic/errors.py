"""The one exception that is meant for the person at the keyboard."""


class InputError(ValueError):
    """The user's input cannot be used.

    The message is one line: what came in (with its unit), what is allowed, what to do next.
    The command line prints it and exits with code 2, with nothing written.
    """

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))
