"""Tables are read in pieces: ten million rows fit into memory."""

import tracemalloc
from pathlib import Path

from ptp_symbolic.numeric.data.formats import read_table


def test_a_log_without_a_last_line_end_takes_no_more_memory(tmp_path: Path) -> None:
    rows = "\n".join(f"{k * 1e-3:.3f},{k % 997}.5" for k in range(200_000))
    peaks = []
    for end in ("\n", ""):
        path = tmp_path / "long.csv"
        path.write_text(f"time [s],pan_angle [rad]\n{rows}{end}", encoding="utf-8")
        table = read_table(path)
        tracemalloc.start()
        table.numbers((0, 1))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.1 * peaks[0]
