from umform.report.repeats import counted


def test_repeated_warnings_are_counted():
    warnings = [
        "step 1, time 0.1000: it chatters; the increment is cut",
        "take care",
        "step 1, time 0.2000: it chatters; the increment is cut",
        "step 2, time 1.3000: it chatters; the increment is cut",
        "step 2, time 1.4000: something else",
    ]
    assert counted(warnings) == [
        "it chatters; the increment is cut (3 times, first at step 1, time 0.1000, last at step 2, time 1.3000)",
        "take care",
        "step 2, time 1.4000: something else",
    ]
    assert counted(["a", "a"]) == ["a (2 times)"]
    assert counted([]) == []
