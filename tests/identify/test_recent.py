"""Values that are kept as long as they are recent."""

from ptp_symbolic.numeric.identify.equation_space import Recent


def test_the_last_values_are_made_once_and_the_oldest_anew() -> None:
    made: list[int] = []

    def square(number: int) -> int:
        made.append(number)
        return number**2

    recent = Recent[int, int]()
    for number in (1, 2, 3, 3, 2):
        assert recent.of(number, lambda n=number: square(n), most=2) == number**2
    assert made == [1, 2, 3]
    assert recent.of(1, lambda: square(1), most=2) == 1
    assert made == [1, 2, 3, 1]
    recent.clear()
    assert recent.of(1, lambda: square(1), most=2) == 1
    assert made == [1, 2, 3, 1, 1]
