"""Messages are made quickly, and as a frozen dataclass makes them."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle

import pytest

from swapcan.messages import B2V_ST2, V2B_VIN, B2C_Charger
from typedcan.model.frozen import quicken


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """A class of a test's own: before and after it is quickened it has to be the same."""

    kind: str
    x: float = 1.5
    self: object = None


def test_what_is_given_is_kept_and_what_is_not_has_its_default() -> None:
    slow = Point(kind="a", x=2.0)
    quicken(Point)
    made = Point.__init__
    for _ in range(2):  # the first one is made otherwise than the second
        assert Point(kind="a", x=2.0) == slow
        assert Point(kind="b") == dataclasses.replace(slow, kind="b", x=1.5)
        assert type(Point(kind="b")) is Point
        with pytest.raises(TypeError, match="kind"):
            Point()  # type: ignore[call-arg]
        with pytest.raises(TypeError, match="y"):
            Point(kind="a", y=1)  # type: ignore[call-arg]
        with pytest.raises(TypeError, match="positional"):
            Point("a")  # type: ignore[call-arg]
    assert Point.__init__ is not made
    assert Point.__init__.__code__.co_filename == "<string>"


def test_messages_are_frozen_compared_copied_and_pickled() -> None:
    message = B2V_ST2(soc=80.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        message.soc = 1.0  # type: ignore[misc]
    assert dataclasses.replace(message, soc=20.0).soc == 20.0
    for other in (copy.copy(message), copy.deepcopy(message), pickle.loads(pickle.dumps(message))):
        assert other == message
        assert type(other) is B2V_ST2
        assert hash(other) == hash(message)


def test_the_signature_stays() -> None:
    V2B_VIN()
    parameters = inspect.signature(B2C_Charger).parameters
    assert parameters["charge_control"].default is inspect.Parameter.empty
    assert [*parameters] == [field.name for field in dataclasses.fields(B2C_Charger)]
    with pytest.raises(TypeError, match="charge_control"):
        B2C_Charger()  # type: ignore[call-arg]


def test_a_class_that_stands_on_a_message_is_made_too() -> None:
    class Tagged(B2V_ST2):
        """A message of a user's with something of his own."""

        tag = "mine"

    B2V_ST2(soc=1.0)
    made = Tagged(soc=80.0)
    assert (type(made), made.soc, made.tag) == (Tagged, 80.0, "mine")
