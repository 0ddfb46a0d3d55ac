"""The snapshot: complete, plain data, and a moment's, not a view."""

import json
import tracemalloc

from supervise.arrivals import frame, received, refused

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2
from swapcan.wire import Receiver
from typedcan.supervise import Supervisor
from typedcan.wire.link import Received


def test_a_snapshot_is_plain_data() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[B2V_ST2, B2V_ST1])
    supervisor.start(10.0)
    supervisor.take(received("B2V_ST2", SOC=100), 10.0)
    supervisor.take(received("B2V_ST2", SOC=255), 10.25)
    supervisor.take(received("B2V_ST1", Flt_Fire=1), 10.25)
    data = json.loads(json.dumps(supervisor.snapshot(10.5).as_dict(), allow_nan=False))
    assert (data["node"], data["time"]) == ("VCU", 10.5)
    messages = {message["name"]: message for message in data["messages"]}
    assert messages["B2V_ST2"] == {
        "name": "B2V_ST2",
        "sender": "BMU",
        "expected": True,
        "expected_period": 0.1,
        "state": "alive",
        "age": 0.25,
        "frames": 2,
        "unmeasured": 0,
        "period": {"count": 1, "mean": 0.25, "jitter": 0.0, "worst": 0.25, "shortest": 0.25},
        "faults": {
            "length": 0,
            "checksum": 0,
            "counter repeated": 0,
            "counter skipped": 0,
            "counter invalid": 0,
            "format": 0,
        },
        "onsets": {"invalid": 1},
        "signals": [
            {
                "field": "soc",
                "part": [],
                "kind": "invalid",
                "value": "Signal Invalid",
                "text": "Signal Invalid",
                "since": 10.25,
            }
        ],
    }
    (fire,) = messages["B2V_ST1"]["signals"]
    assert (fire["kind"], fire["value"], fire["text"]) == ("alarm", 1, "Fault")
    never = messages["B2V_ST3"]
    assert (never["state"], never["age"], never["expected"]) == ("never seen", None, False)
    assert never["period"]["mean"] is None


def test_a_snapshot_has_what_is_meant_for_the_node_and_what_came() -> None:
    supervisor = Supervisor(PROTOCOL, "TMS")
    names = [message.name for message in supervisor.snapshot(0.0).messages]
    assert names == ["BMS_TMS_0"]
    supervisor.take(received("B2V_ST2"), 0.0)
    supervisor.fault(refused("B2V_ST3"), 0.0)
    names = [message.name for message in supervisor.snapshot(0.0).messages]
    assert names == ["B2V_ST2", "B2V_ST3", "BMS_TMS_0"]


def test_a_snapshot_stays_as_it_was() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    supervisor.take(received("B2V_ST2", SOC=255), 0.0)
    snapshot = supervisor.snapshot(0.0)
    before = json.dumps(snapshot.as_dict())
    supervisor.take(received("B2V_ST2", SOC=1, SOH=255), 0.5)
    assert json.dumps(snapshot.as_dict()) == before


def test_onsets_are_counted_not_frames() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for n, soc in enumerate((255, 255, 10, 255, 255, 255, 10)):
        supervisor.take(received("B2V_ST2", SOC=soc), n * 0.1)
    (message,) = (m for m in supervisor.snapshot(1.0).messages if m.name == "B2V_ST2")
    assert message.onsets == {"invalid": 2}
    assert message.signals == ()


def test_an_alarm_that_gets_graver_is_as_old_as_it_was() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for n, level in enumerate((0, 1, 2, 2)):
        supervisor.take(received("B2V_ST1", Flt_OverTemp=level), float(n))
    (message,) = (m for m in supervisor.snapshot(4.0).messages if m.name == "B2V_ST1")
    (alarm,) = message.signals
    assert (alarm.since, alarm.text) == (1.0, "Level 2-More severe fault")
    assert message.onsets == {"alarm": 1}


def test_memory_does_not_grow_with_the_number_of_frames() -> None:
    receiver, supervisor = Receiver(), Supervisor(PROTOCOL, "VCU")
    supervisor.start(0.0)
    turn = [
        *(frame("B2V_ST1", ALIV=n % 15, Flt_OverTemp=n % 4) for n in range(20)),
        *(frame("B2V_Ucell", CSCNo=n, FrameNo=1) for n in range(18)),
        *(frame("B2V_ST2", SOC=250 + n % 6) for n in range(20)),
    ]

    def run(start: float) -> None:
        for n, one in enumerate(turn * 20):
            one.timestamp = start + n * 0.001
            taken = receiver.take(one)
            assert isinstance(taken, Received)
            supervisor.take(taken, one.timestamp)
            supervisor.check(one.timestamp)

    run(0.0)
    tracemalloc.start()
    try:
        run(10.0)
        before, _ = tracemalloc.get_traced_memory()
        for n in range(2, 7):
            run(n * 10.0)
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # 5 x 1160 frames; a mere float kept for each would be 140,000 bytes.
    assert after - before < 10_000
