"""Philox4x32-10 for all lanes at once: the integers of `fddbench.blocks.philox`."""

from fddbench.blocks.targets.llvm.arithmetic import operation
from fddbench.blocks.targets.llvm.writer import Vectors

__all__ = ["keys", "uniform", "words"]

_M0, _M1, _W0, _W1 = 0xD2511F53, 0xCD9E8D57, 0x9E3779B9, 0xBB67AE85
_LOW = 0xFFFFFFFF


def keys(o: Vectors) -> None:
    """Both words of the key in each of the ten rounds, as ``%low_0`` to ``%high_9``, from ``%key``."""
    o.do(f"%key_low = and i64 %key, {_LOW}")
    o.do("%key_high = lshr i64 %key, 32")
    for j in range(10):
        for name, step in (("low", _W0), ("high", _W1)):
            wide = o.let(f"add i64 %key_{name}, {j * step}")
            o.do(f"%{name}_{j} = and i64 {wide}, {_LOW}")


def words(o: Vectors, consumer: int, stream: str) -> list[str]:
    """Four random words of every lane, Philox4x32-10 of ``%k_word``, the consumer, ``%run_words`` and the stream."""
    x0, x1, x2, x3 = o.spread("i64", "%k_word"), o.integer(consumer), "%run_words", f"%{stream}_words"
    for j in range(10):
        p0, p1 = (o.let(f"mul {o.I} {x}, {o.integer(m)}") for x, m in ((x0, _M0), (x2, _M1)))
        x0, x2 = _mixed(o, p1, x1, f"%low_{j}"), _mixed(o, p0, x3, f"%high_{j}")
        x1, x3 = (o.let(f"and {o.I} {product}, {o.integer(_LOW)}") for product in (p1, p0))
    return [x0, x1, x2, x3]


def _mixed(o: Vectors, product: str, word: str, key: str) -> str:
    """High word of a product, exclusive or with a word and a key."""
    high = o.let(f"lshr {o.I} {product}, {o.integer(32)}")
    return o.let(f"xor {o.I} {o.let(f'xor {o.I} {high}, {word}')}, {o.spread('i64', key)}")


def uniform(o: Vectors, word: str) -> str:
    """Number of the open interval (0, 1) of a word, ``(word + 1/2) / 2^32``."""
    return operation(o, "mul", operation(o, "add", o.whole(word), o.number(0.5)), o.number(2.0**-32))
