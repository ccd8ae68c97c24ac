"""Critical speeds over 64 pairs of numbers of a bogie, kept in a file case by case."""

from exudyn_wheelset import WheelsetError, linear_critical_speed, study
from exudyn_wheelset.catalogue import vehicle


def critical(case):
    return linear_critical_speed(vehicle("cooperrider", **case), 20, 150)


def main():
    cases = {
        "conicity": [0.04 + 0.02 * k for k in range(8)],
        "friction": [0.1 + 0.05 * k for k in range(8)],
    }
    found = study(critical, cases, executor=1, file="map.jsonl", progress=False)
    speeds = found.table["value"]
    assert len(speeds) == 64 and speeds[-1] < speeds[0]
    try:
        study(critical, cases, executor=0)
    except WheelsetError as error:
        assert "executor = 0" in str(error)
    else:
        raise AssertionError("no process at all was taken")


if __name__ == "__main__":
    main()
