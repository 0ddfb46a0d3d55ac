"""All messages of the protocol and the enums of their codes: import them from here."""

from swapcan._generated.enums import *
from swapcan._generated.messages import *
