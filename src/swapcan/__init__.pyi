# The public names: the only list of them, see __init__.py.
from swapcan._generated.protocol import PROTOCOL as PROTOCOL
from swapcan.node import (
    BatteryInfo as BatteryInfo,
    BusBack as BusBack,
    BusLost as BusLost,
    Event as Event,
    Node as Node,
    NodeFailed as NodeFailed,
    Overrun as Overrun,
    Pending as Pending,
    ReceiveFailed as ReceiveFailed,
    SendFailed as SendFailed,
)
from typedcan.supervise import (
    NotSeen as NotSeen,
    SignalChanged as SignalChanged,
    State as State,
    StateChanged as StateChanged,
)
from swapcan.transfer import (
    CellVoltages as CellVoltages,
    PackCode as PackCode,
    ProbeTemperatures as ProbeTemperatures,
    Problem as Problem,
    Vin as Vin,
)
from swapcan.wire import (
    Codec as Codec,
    Link as Link,
    codec_for as codec_for,
    dbc_text as dbc_text,
    decode as decode,
    encode as encode,
    message_type as message_type,
)
from swapcan.wire import SwapcanError as SwapcanError
from typedcan.model.errors import DatabaseError as DatabaseError
from typedcan.wire.errors import (
    ChecksumError as ChecksumError,
    DecodeError as DecodeError,
    EncodeError as EncodeError,
    LengthError as LengthError,
    ReceiveTimeoutError as ReceiveTimeoutError,
    SendingError as SendingError,
    UnknownFrameError as UnknownFrameError,
    UnknownMessageError as UnknownMessageError,
    UnknownNodeError as UnknownNodeError,
)
from typedcan.node.errors import (
    RequestError as RequestError,
    RequestTimeoutError as RequestTimeoutError,
    StillActingError as StillActingError,
)
from typedcan.transfer import TransferError as TransferError
from typedcan.wire.link import (
    Counts as Counts,
    Fault as Fault,
    Received as Received,
)
from typedcan.wire.message import Message as Message
from typedcan.model.signal_state import SignalState as SignalState

__all__: list[str]
