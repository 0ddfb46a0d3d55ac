"""Types of codes that a field of so many bits can hold, for fields whose codes have labels.

A type checker takes them for no other enum and no bool, and refuses a code that has no room. A code
that is known at run time only is given as a member of the field's enum: ``HvCommand(code)``.
"""

from __future__ import annotations

from typing import Literal

Code1 = Literal[0, 1]
Code2 = Literal[Code1, 2, 3]
Code3 = Literal[Code2, 4, 5, 6, 7]
Code4 = Literal[Code3, 8, 9, 10, 11, 12, 13, 14, 15]
Code5 = Literal[Code4, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31]
_From32 = Literal[32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47]
_From48 = Literal[48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63]
Code6 = Literal[Code5, _From32, _From48]
_From64 = Literal[64, 65, 66, 67, 68, 69, 70, 71, 72, 73, 74, 75, 76, 77, 78, 79]
_From80 = Literal[80, 81, 82, 83, 84, 85, 86, 87, 88, 89, 90, 91, 92, 93, 94, 95]
_From96 = Literal[96, 97, 98, 99, 100, 101, 102, 103, 104, 105, 106, 107, 108, 109, 110, 111]
_From112 = Literal[112, 113, 114, 115, 116, 117, 118, 119, 120, 121, 122, 123, 124, 125, 126, 127]
Code7 = Literal[Code6, _From64, _From80, _From96, _From112]
_From128 = Literal[128, 129, 130, 131, 132, 133, 134, 135, 136, 137, 138, 139, 140, 141, 142, 143]
_From144 = Literal[144, 145, 146, 147, 148, 149, 150, 151, 152, 153, 154, 155, 156, 157, 158, 159]
_From160 = Literal[160, 161, 162, 163, 164, 165, 166, 167, 168, 169, 170, 171, 172, 173, 174, 175]
_From176 = Literal[176, 177, 178, 179, 180, 181, 182, 183, 184, 185, 186, 187, 188, 189, 190, 191]
_From192 = Literal[192, 193, 194, 195, 196, 197, 198, 199, 200, 201, 202, 203, 204, 205, 206, 207]
_From208 = Literal[208, 209, 210, 211, 212, 213, 214, 215, 216, 217, 218, 219, 220, 221, 222, 223]
_From224 = Literal[224, 225, 226, 227, 228, 229, 230, 231, 232, 233, 234, 235, 236, 237, 238, 239]
_From240 = Literal[240, 241, 242, 243, 244, 245, 246, 247, 248, 249, 250, 251, 252, 253, 254, 255]
Code8 = Literal[
    Code7, _From128, _From144, _From160, _From176, _From192, _From208, _From224, _From240
]
