"""Which signals a name means."""

from __future__ import annotations

import pytest

from swapcan.log_protocol import OWN
from typedcan.logs.plan import SelectionError
from typedcan.logs.plot.names import find_signals


def found(*names: str) -> list[str]:
    return [".".join(pair) for pair in find_signals(OWN, names)]


@pytest.mark.parametrize(
    "name", ["B2V_ST2_SOC", "b2v_st2_soc", "B2V_ST2.B2V_ST2_SOC", "SOC", "soc", "ST2_SOC"]
)
def test_a_signal_goes_by_its_name_or_the_end_of_it(name: str) -> None:
    assert found(name) == ["B2V_ST2.B2V_ST2_SOC"]


def test_underscores_do_not_matter_in_the_end_of_a_name() -> None:
    assert found("max_lmt_dis_chg_curr") == ["B2V_ST2.B2V_ST2_MaxLmt_DisChgCurr"]


def test_a_pattern_means_all_that_fit_and_each_is_taken_once() -> None:
    names = found("B2V_ST2_SO?", "*SOC", "B2V_ST2.*")
    assert names[:2] == ["B2V_ST2.B2V_ST2_SOC", "B2V_ST2.B2V_ST2_SOH"]
    assert len(names) == len(set(names))
    assert "B2V_ST2.B2V_ST2_Current" in names


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("SOX", "there is no signal 'SOX'; did you mean .*B2V_ST2_SOC"),
        ("Currant", "did you mean B2V_ST2_Current"),
        ("CSCNo", "signals end in 'CSCNo' .*B2V_UC_CSCNo.*name one, or ask for"),
        ("*qqq*", r"there is no signal '\*qqq\*'$"),
    ],
)
def test_what_is_none_or_several_is_one_line_with_those_it_may_be(name: str, text: str) -> None:
    with pytest.raises(SelectionError, match=text) as caught:
        found(name)
    assert "\n" not in str(caught.value)
