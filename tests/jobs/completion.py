"""What an editor and an interactive session offer."""

import inspect

import exudyn_wheelset

names = dir(exudyn_wheelset)
assert {"create_wheelset", "linear_critical_speed", "Motion", "warm_up"} <= set(names)
for name in names:
    thing = getattr(exudyn_wheelset, name)
    if inspect.isfunction(thing):
        assert inspect.signature(thing) is not None and thing.__doc__, name
try:
    getattr(exudyn_wheelset, "create_wheelsets")  # noqa: B009
except AttributeError as error:
    assert "create_wheelsets" in str(error)
else:
    raise AssertionError("a name that is none was found")
