"""`python -m ptp_symbolic`: the command `ptp-symbolic`, for a checkout that is not installed."""

from ptp_symbolic.cli import main

if __name__ == "__main__":
    main()
