"""`swapcan send`: what is typed, what goes out, and what is refused with nothing going out."""

from __future__ import annotations

import can
import pytest

from swapcan import cli

Capture = pytest.CaptureFixture[str]


def send(channel: str, *words: str) -> int:
    return cli.run(["send", *words, "-i", "virtual", "-c", channel])


@pytest.mark.parametrize(
    ("words", "data"),
    [
        (["B2V_ST2", "soc=80", "current=-120.5"], "c8ff5b22ffffffff"),
        (["b2v_st2", "SOC=80", "B2V_ST2_Current=-120.5"], "c8ff5b22ffffffff"),
        (["B2V_ST2", "soc = 8e1", "soh=invalid"], "c8ffffffffffffff"),
        (["B2V_ST5", "max_ucell=Abnormal", "avg_ucell=3.3"], "fe1fff00e40c0000"),
        (["B2V_ST5", "max_ucell_csc_no=18", "max_ucell_position=0x0c"], "ff1f120cff1f0000"),
        (["B2V_RQ", "vin=Request VIN", "hv_off=2"], "0900000000000000"),
        (["B2V_RQ", "vin=request_vin", "hv_off=INVALID"], "0d00000000000000"),
        (["B2V_RQ", "vin=no request vin", "hv_off=0x1"], "0600000000000000"),
        (["B2V_ST1", "bms=hv closed"], "2020000000000000"),
        (["B2V_BattInfo1", "batt_type=reserved_12"], "ffffffffffff0c00"),
        (["B2V_BattInfo1", "batt_type=Ternary (NMC or NCA)"], "ffffffffffff0600"),
        (["V2B_VIN", "frame_no=1", "b1_8_15=L", "b2_9_16=0", "b3_10_17=0x5A"], "014c305a00000000"),
    ],
)
def test_a_message_goes_out_as_typed(
    channel: str, far: can.BusABC, words: list[str], data: str, capsys: Capture
) -> None:
    assert send(channel, *words) == 0
    frame = far.recv(1.0)
    assert frame is not None
    assert frame.data.hex() == data
    out, errors = capsys.readouterr()
    assert out.startswith(f"0x{frame.arbitration_id:08X}  [{frame.data.hex(' ').upper()}]  ")
    assert (out.count("\n"), errors) == (1, "")
    assert far.recv(0) is None


def test_the_values_printed_are_those_that_went_out(
    channel: str, far: can.BusABC, capsys: Capture
) -> None:
    assert send(channel, "B2V_ST2", "soc=80.1", "current=0.04") == 0
    assert capsys.readouterr().out == (
        "0x1882D0F3  [C8 FF 10 27 FF FF FF FF]  B2V_ST2  soc=80 %  soh=Signal Invalid"
        "  current=0 A  max_lmt_chg_curr=Signal Invalid  max_lmt_dis_chg_curr=Signal Invalid\n"
    )


REFUSED = {
    ("B2C_Charger", "voltage_set=700", "current_set=50"): (
        "B2C_Charger.charge_control has to be given: left out it would be sent as Start to charge;"
        " it knows Start to charge, Normal Stop to charge, Fault - Stop to charge\n"
    ),
    ("BMS_TMS_0",): (
        "BMS_TMS_0.reqst_tms_hv_on has to be given: left out it would be sent as Request HV on;"
        " it knows Request HV on, Request HV off\n"
    ),
    ("C2B_ACStatus", "charger_ready=0"): (
        "C2B_ACStatus.charger_start has to be given: left out it would be sent as On; it knows On, "
    ),
    ("B2V_ST22",): "there is no message 'B2V_ST22'; did you mean B2V_ST2 or ",
    ("Motor",): "there is no message 'Motor'; known are V2B_CMD, B2V_RQ, ",
    ("B2V_ST2", "sok=1"): "B2V_ST2 has no field 'sok'; did you mean ",
    ("B2V_ST2", "torque=1"): "B2V_ST2 has no field 'torque'; known are soc, soh, current, ",
    ("B2V_ST2", "soc"): "expected FIELD=VALUE, not 'soc'",
    ("B2V_ST2", "soc=80", "B2V_ST2_SOC=81"): "B2V_ST2.soc is given twice",
    ("B2V_ST2", "soc=full"): "B2V_ST2.soc: expected a number, not 'full'",
    ("B2V_ST2", "soc="): "B2V_ST2.soc: expected a number, not ''",
    ("B2V_ST2", "soc=102.4"): "B2V_ST2.soc: 102.4 % is out of range; allowed are 0 to 102 %",
    ("B2V_ST2", "soc=102"): "B2V_ST2.soc: 102 would be sent as raw 255, which means Signal Invalid",
    ("B2V_ST2", "soc=nan"): "B2V_ST2.soc: nan is not a finite number; allowed are 0 to 102 %",
    ("B2V_ST2", "soc=inf"): "B2V_ST2.soc: inf is not a finite number; allowed are 0 to 102 %",
    ("B2V_ST2", "soc=-inf"): "B2V_ST2.soc: -inf is not a finite number; allowed are 0 to 102 %",
    ("B2V_ST2", "soc=abnormal"): "B2V_ST2.soc: has no code for Abnormal",
    ("B2V_ST1", "bms=open"): "B2V_ST1.bms: unknown label 'open'; known are HV open, Precharge, HV",
    ("B2V_ST1", "bms=4"): "B2V_ST1.bms: 4 is no BmsState: expected BmsState or a code 0 to 3",
    ("B2V_ST2", "soc=1e400"): "B2V_ST2.soc: inf is not a finite number; allowed are 0 to 102 %",
    ("B2V_ST1", "aliv=3"): "B2V_ST1.aliv is filled in when sending",
    ("B2V_ST1", "B2V_ST1_Checksum=3"): "B2V_ST1.checksum is filled in when sending",
    ("B2V_BattInfo1", "batt_type=Reserved"): "'Reserved' is each of the codes 10, 11, 12, 13",
    ("B2V_ST4", "max_temp_position=1.5"): "expected a whole number, not '1.5'",
    ("B2V_ST4", "max_temp_position=256"): "256 is out of range; allowed are 0 to 255",
    ("V2B_VIN", "b1_8_15=LL"): "V2B_VIN.b1_8_15: expected a character, not 'LL'",
    ("V2B_VIN", "b1_8_15=?"): "V2B_VIN.b1_8_15: '?' is none of the characters 0123456789ABC",
}


@pytest.mark.parametrize(("words", "text"), REFUSED.items(), ids=" ".join)
def test_what_cannot_be_sent_is_one_line_and_no_bus_is_opened(
    channel: str,
    words: tuple[str, ...],
    text: str,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def never(*arguments: object, **options: object) -> None:
        raise AssertionError("a bus was opened")

    monkeypatch.setattr(can, "Bus", never)
    assert send(channel, *words) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert errors.startswith("swapcan: ")
    assert text in errors
    assert errors.count("\n") == 1


@pytest.mark.parametrize(
    ("word", "text"),
    [
        ("bms={}", "B2V_ST1.bms: unknown label '{}"),
        ("{}=1", "B2V_ST1 has no field '{}"),
        ("{}", "expected FIELD=VALUE, not '{}"),
    ],
)
def test_of_what_is_too_long_the_error_shows_a_part(word: str, text: str, capsys: Capture) -> None:
    assert send("nowhere", "B2V_ST1", word.format(1000 * "x")) == 2
    errors = capsys.readouterr().err
    assert text.format("xxxxxxxxxx") in errors
    assert errors.count("x") < 100
    assert errors.count("\n") == 1


def test_a_number_of_any_length_is_refused_in_a_short_line(capsys: Capture) -> None:
    for digits in (100, 4000, 5000):
        for field in ("bms", "gbt32960_flt_num"):
            assert send("nowhere", "B2V_ST1", f"{field}={digits * '9'}") == 2
            errors = capsys.readouterr().err
            assert errors.startswith(f"swapcan: B2V_ST1.{field}: ")
            assert len(errors) < 250


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["-i", "nothing"], "'nothing'"),
        (["-i", "virtual", "-b", "fast"], "--bitrate"),
        (["-i", "virtual", "--bus-kwargs", "fd"], "expected NAME=VALUE, not 'fd'"),
        (["-i", "virtual", "--bus-kwargs", "port=x"], "cannot open the bus: "),
        (["-i", "udp_multicast", "-c", "10.0.0.1"], "cannot open the bus: "),
        (["-i", "neovi", "-c", "0"], "cannot open the bus: "),
        (["-i", "kvaser", "-c", "0"], "cannot open the bus: "),
        (["-i", "socketcand"], "cannot open the bus: "),
    ],
)
def test_a_bus_that_cannot_be_opened_is_one_line(
    options: list[str], text: str, capsys: Capture
) -> None:
    assert cli.run(["send", "B2V_ST2", *options]) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert errors.startswith("swapcan: ")
    assert text in errors
    assert errors.count("\n") == 1


def test_without_an_interface_the_configuration_of_python_can_is_used(
    channel: str, far: can.BusABC, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(can, "rc", {"interface": "virtual", "channel": channel})
    assert cli.run(["send", "B2V_ST2", "soc=80"]) == 0
    assert far.recv(1.0) is not None


def test_an_interface_that_nobody_names_is_asked_for(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(can.util, "load_file_config", lambda *_: {})
    monkeypatch.delenv("CAN_INTERFACE", raising=False)
    assert cli.run(["send", "B2V_ST2"]) == 2
    assert capsys.readouterr().err.endswith("; --interface names one\n")
