"""CRC-32C and XXH3-64 in numpy, so that decoding needs no compiled package for them."""

import struct

import numpy as np

_LANE = 64  # bytes


def _crc_table():
    table = np.arange(256, dtype="u4")
    for _ in range(8):
        table = np.where(table & 1, (table >> 1) ^ np.uint32(0x82F63B78), table >> 1)
    return table


_TABLE = _crc_table()
_TABLE_LIST = _TABLE.tolist()


def _lane_shift():
    """What _LANE zero bytes make of each byte of a register: four tables of 256."""
    tables = []
    for byte in range(4):
        register = np.arange(256, dtype="u4") << np.uint32(8 * byte)
        for _ in range(_LANE):
            register = _TABLE[register & 0xFF] ^ (register >> np.uint32(8))
        tables.append(register.tolist())
    return tables


_SHIFT = _lane_shift()


def crc32c(data):
    """CRC-32C (Castagnoli) of bytes.

    Long inputs are cut into lanes that numpy carries side by side from a register of zero; each
    lane is then moved past those behind it, which is linear over GF(2).
    """
    head = len(data) % _LANE if len(data) >= 4 * _LANE else len(data)
    register = 0xFFFFFFFF
    for byte in data[:head]:
        register = _TABLE_LIST[(register ^ byte) & 0xFF] ^ (register >> 8)
    if head < len(data):
        lanes = np.frombuffer(data, "u1", offset=head).reshape(-1, _LANE)
        columns = np.ascontiguousarray(lanes.T).astype("u4")
        registers = np.zeros(len(lanes), "u4")
        for column in columns:
            registers = _TABLE[(registers ^ column) & 0xFF] ^ (registers >> np.uint32(8))
        low, second, third, high = _SHIFT
        for lane in registers.tolist():
            register = (
                low[register & 0xFF]
                ^ second[(register >> 8) & 0xFF]
                ^ third[(register >> 16) & 0xFF]
                ^ high[register >> 24]
                ^ lane
            )
    return register ^ 0xFFFFFFFF


_SECRET = bytes.fromhex(
    "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671f"
    "cb79e64eccc0e578825ad07dccff7221b8084674f743248ee03590e6813a264c"
    "3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8"
    "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364"
    "eac5ac8334d3ebc3c581a0fffa1363eb170ddd51b7f0da49d316552629d4689e"
    "2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e"
)
_MASK = 2**64 - 1
_P32 = (0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D)
_P64 = (
    0x9E3779B185EBCA87,
    0xC2B2AE3D27D4EB4F,
    0x165667B19E3779F9,
    0x85EBCA77C2B2AE63,
    0x27D4EB2F165667C5,
)


def xxh3_64(data):
    """XXH3-64 with seed 0 and the default secret, of more than 240 bytes."""
    if len(data) <= 240:
        raise ValueError("only inputs above 240 bytes are hashed here")
    sums = np.array([_P32[2], *_P64[:4], _P32[1], _P64[4], _P32[0]], "u8")
    stripe_keys = np.stack([np.frombuffer(_SECRET, "<u8", 8, 8 * n) for n in range(16)])
    scramble_key = np.frombuffer(_SECRET, "<u8", 8, 128)
    swap = [1, 0, 3, 2, 5, 4, 7, 6]
    low = np.uint64(0xFFFFFFFF)

    def added(stripes, keys):
        """What stripes (..., n, 8) add to the sums; additions wrap and commute."""
        mixed = stripes ^ keys
        products = (mixed & low) * (mixed >> np.uint64(32))
        return (products + stripes[..., swap]).sum(axis=-2, dtype="u8")

    blocks = (len(data) - 1) // 1024
    whole = np.frombuffer(data, "<u8", blocks * 128).reshape(blocks, 16, 8)
    for block in added(whole, stripe_keys):
        sums = sums + block
        sums = (sums ^ (sums >> np.uint64(47)) ^ scramble_key) * np.uint64(_P32[0])
    stripes = (len(data) - 1 - 1024 * blocks) // 64
    tail = np.frombuffer(data, "<u8", 8 * stripes, 1024 * blocks).reshape(stripes, 8)
    sums = sums + added(tail, stripe_keys[:stripes])
    last = np.frombuffer(data, "<u8", 8, len(data) - 64).reshape(1, 8)
    sums = sums + added(last, np.frombuffer(_SECRET, "<u8", 8, 121))

    result = (len(data) * _P64[0]) & _MASK
    keys = struct.unpack_from("<8Q", _SECRET, 11)
    accumulators = sums.tolist()
    for pair in range(0, 8, 2):
        product = (accumulators[pair] ^ keys[pair]) * (accumulators[pair + 1] ^ keys[pair + 1])
        result = (result + ((product & _MASK) ^ (product >> 64))) & _MASK
    result ^= result >> 37
    result = (result * 0x165667919E3779F9) & _MASK
    return result ^ (result >> 32)
