"""A small spec of a made-up protocol, whole and sound, to be changed by tests."""

from __future__ import annotations

from pathlib import Path

FILES = {
    "standard.yaml": """\
number: X 1
title: 温控器
english: Thermostat
nodes:
  - {name: PANEL, english: Control panel, title: 面板, address: 0x10}
  - {name: HEATER, english: Heater, title: 加热器, address: 0x20, aliases: [HTR]}
buses:
  - {name: house, english: House bus, bit_rate: 125000, nodes: [PANEL, HEATER]}
frame_format: ExtendedCAN
reserved: [Reserved]
units: {℃: degC}
invalid_labels: [Invalid]
abnormal_labels: [Broken]
value_tables: {HeaterMode: H_Mode, TemperatureState: H_Temp}
""",
    "messages.yaml": """\
annex: A
byte_order: Intel
messages:
  - id: 0x18FF0120
    name: Heater
    english: Heater state
    length: 8
    type: Cyclic
    period: 100
    signals:
      - {name: H_Sum, length: 8, start: 0}
      - {name: H_Live, length: 4, start: 8}
      - {name: H_Mode, length: 2, start: 12}
      - {name: Reserved, length: 2, start: 14}
      - {name: H_Temp, length: 8, start: 16}
      - {name: Reserved, length: 8, start: 24}
  - id: 0x18FF0210
    name: Panel
    english: Panel request
    length: 8
    type: Event
    period: 0
    byte_order: Motorola
    signals:
      - {name: P_WantedTemp, length: 16, start: 7}
""",
    "tables/01-heater.yaml": """\
number: 1
title: 加热器状态
english: Heater state
clause: 5.1
rows:
  - no: 1
    name: H_Sum
    title: 校验和
    english: Checksum
    length: 8
    factor: 1
    offset: 0
    unit: ""
    range: 0~255
    route: HTR>PANEL
  - no: 2
    name: H_Live
    title: 生命信号
    english: Alive counter
    length: 4
    factor: 1
    offset: 0
    unit: ""
    range: 0~15
    route: HTR>PANEL
  - no: 3
    name: H_Mode
    title: 模式
    english: Mode
    length: 2
    codes: {0: 关, 1: 开, 2: ECO, 3: Invalid}
    english_codes: {0: "Off", 1: "On"}
    factor: 1
    offset: 0
    unit: ""
    range: 0~3
    route: HTR>PANEL
  - no: 4
    name: H_Temp
    title: 温度
    english: Temperature
    length: 8
    codes: {254: Broken, 255: Invalid}
    factor: 0.5
    offset: -40
    unit: ℃
    range: -40~87.5
    route: HTR>PANEL
""",
    "tables/02-panel.yaml": """\
number: 2
title: 面板请求
english: Panel request
clause: 5.2
rows:
  - no: 1
    name: P_WantedTemp
    title: 目标温度
    english: Wanted temperature
    length: 16
    factor: 0.1
    offset: 0
    unit: ℃
    range: 5~30
    route: PANEL>HTR
""",
    "behaviour.yaml": """\
checksums:
  - {signal: H_Sum, algorithm: xor, bytes: 1~7}
counters:
  - {signal: H_Live, modulus: 16}
timing:
  - {name: always, condition: always, messages: [Heater]}
  - {name: on_change, condition: when the wanted temperature changes, messages: [Panel]}
""",
}
PYPROJECT = """\
[tool.dbcspec]
name = "thermo"
spec = "spec"
dbc = "out"
"""


def write_spec(folder: Path, **changed: str) -> Path:
    """Write the spec below a folder; a keyword replaces the file of that stem, "" leaves it out."""
    spec = folder / "spec"
    (spec / "tables").mkdir(parents=True, exist_ok=True)
    names = {Path(name).stem: name for name in FILES} | {"errata": "errata.yaml"}
    unknown = set(changed) - set(names)
    assert not unknown, f"no such file: {unknown}"
    texts = {**FILES, **{names[stem]: text for stem, text in changed.items()}}
    for name, text in texts.items():
        if text:
            (spec / name).write_text(text, "utf-8")
    return spec


def write_project(folder: Path, **changed: str) -> Path:
    """Write a whole project: pyproject.toml and spec."""
    (folder / "pyproject.toml").write_text(PYPROJECT, "utf-8")
    write_spec(folder, **changed)
    return folder


def edited(name: str, old: str, new: str) -> str:
    """The text of a file with one passage replaced."""
    text = FILES[name]
    assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {name}"
    return text.replace(old, new)
