# The public names: the only list of them, see __init__.py.
from swapcan._generated.protocol import PROTOCOL as PROTOCOL
from swapcan.node import (
    BatteryInfo as BatteryInfo,
)
from swapcan.node import (
    BusBack as BusBack,
)
from swapcan.node import (
    BusLost as BusLost,
)
from swapcan.node import (
    Event as Event,
)
from swapcan.node import (
    Node as Node,
)
from swapcan.node import (
    NodeFailed as NodeFailed,
)
from swapcan.node import (
    Overrun as Overrun,
)
from swapcan.node import (
    Pending as Pending,
)
from swapcan.node import (
    ReceiveFailed as ReceiveFailed,
)
from swapcan.node import (
    SendFailed as SendFailed,
)
from swapcan.transfer import (
    CellVoltages as CellVoltages,
)
from swapcan.transfer import (
    PackCode as PackCode,
)
from swapcan.transfer import (
    ProbeTemperatures as ProbeTemperatures,
)
from swapcan.transfer import (
    Problem as Problem,
)
from swapcan.transfer import (
    Vin as Vin,
)
from swapcan.wire import (
    Codec as Codec,
)
from swapcan.wire import (
    Link as Link,
)
from swapcan.wire import SwapcanError as SwapcanError
from swapcan.wire import (
    dbc_text as dbc_text,
)
from swapcan.wire import (
    decode as decode,
)
from swapcan.wire import (
    encode as encode,
)
from swapcan.wire import (
    message_type as message_type,
)
from typedcan.supervise import NotSeen as NotSeen
from typedcan.supervise import SignalChanged as SignalChanged
from typedcan.supervise import State as State
from typedcan.supervise import StateChanged as StateChanged
from typedcan.wire.errors import (
    ChecksumError as ChecksumError,
)
from typedcan.wire.errors import (
    DatabaseError as DatabaseError,
)
from typedcan.wire.errors import (
    DecodeError as DecodeError,
)
from typedcan.wire.errors import (
    EncodeError as EncodeError,
)
from typedcan.wire.errors import (
    LengthError as LengthError,
)
from typedcan.wire.errors import (
    ReceiveTimeoutError as ReceiveTimeoutError,
)
from typedcan.wire.errors import (
    RequestError as RequestError,
)
from typedcan.wire.errors import (
    RequestTimeoutError as RequestTimeoutError,
)
from typedcan.wire.errors import (
    SendingError as SendingError,
)
from typedcan.wire.errors import (
    StillActingError as StillActingError,
)
from typedcan.wire.errors import (
    TransferError as TransferError,
)
from typedcan.wire.errors import (
    UnknownFrameError as UnknownFrameError,
)
from typedcan.wire.errors import (
    UnknownMessageError as UnknownMessageError,
)
from typedcan.wire.errors import (
    UnknownNodeError as UnknownNodeError,
)
from typedcan.wire.link import (
    Counts as Counts,
)
from typedcan.wire.link import (
    Fault as Fault,
)
from typedcan.wire.link import (
    Received as Received,
)
from typedcan.wire.message import (
    Message as Message,
)
from typedcan.wire.message import (
    SignalState as SignalState,
)
