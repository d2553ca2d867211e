"""LLVM text of loads, stores, draws and calls; the frame provides ``%work, %constants, %tile, %n, %o, %k, %time, %active``."""

from collections.abc import Callable
from typing import Any

from fddbench.blocks.targets.llvm import random
from fddbench.blocks.targets.llvm.arithmetic import ARITHMETIC
from fddbench.blocks.targets.llvm.writer import Vectors

__all__ = ["table"]

Line = str | Callable[..., Any]


def table(slots: int, n_recorded: int) -> dict[str, Line]:
    """Text of every instruction of a plan with so many vectors of workspace and recorded rows.

    An entry is a template, or a function (writer, value of the instruction, results of the arguments) -> result.
    """
    return {
        **ARITHMETIC,
        "literal": lambda o, value: o.number(value),
        "flag": lambda o, value: o.flag(bool(value)),
        "load": lambda o, value: o.load(value),
        "store": lambda o, value, a: o.store(a, value),
        "constant": _constant,
        "time": lambda o, _: o.spread("double", "%time"),
        "draw": lambda o, value: random.words(o, *value),
        "uniform": lambda o, value, words: random.uniform(o, words[value]),
        "ring_load": _ring_load,
        "ring_store": lambda o, value, index, a: _ring_store(o, value, index, a, spare=slots - 1),
        "index": lambda o, _, a: o.let(f"fptosi {o.V} {a} to <{o.lanes} x i32>"),
        "gather": _gather,
        "call": lambda o, value: o.do(f"call void @repeat_{value[0]}(ptr {o.slot(value[1])})"),
        "skip": _skip,
        "resume": _resume,
        "join": _join,
        "record": lambda o, value, a: _record(o, value, a, n_recorded),
    }


def _constant(o: Vectors, row: int) -> str:
    index = o.let(f"add i64 {o.let(f'mul i64 %n, {row}')}, %o")
    return o.let(f"load {o.V}, ptr {o.let(f'getelementptr inbounds double, ptr %constants, i64 {index}')}, align 8")


def _whole(o: Vectors, index: str) -> tuple[str, str]:
    """Index of all lanes as a double and as an integer."""
    double = o.let(f"extractelement {o.V} {index}, i64 0")
    return double, o.let(f"fptosi double {double} to i64")


def _ring_load(o: Vectors, value: tuple[int, int], index: str) -> str:
    first, depth = value
    _, whole = _whole(o, index)
    for comparison, limit in (("sgt", 0), ("slt", depth - 1)):
        whole = o.let(f"select i1 {o.let(f'icmp {comparison} i64 {whole}, {limit}')}, i64 {whole}, i64 {limit}")
    return o.load(o.let(f"add i64 {whole}, {first}"))


def _ring_store(o: Vectors, value: tuple[int, int], index: str, a: str, *, spare: int) -> None:
    """Store in the row whose turn it is; in the spare vector, which nobody reads, when it is no row's turn."""
    first, depth = value
    double, whole = _whole(o, index)
    equal = o.let(f"fcmp oeq double {o.let(f'sitofp i64 {whole} to double')}, {double}")
    inside = o.let(f"and i1 {equal}, {o.let(f'icmp ult i64 {whole}, {depth}')}")
    row = o.let(f"add i64 {whole}, {first}")
    o.store(a, o.let(f"select i1 {inside}, i64 {row}, i64 {spare}"))


def _gather(o: Vectors, number: int, index: str) -> str:
    """One load a lane, all lanes taking part; the index is in the table, so nothing is read that is not there."""
    places = f"<{o.lanes} x ptr>"
    here = o.let(f"getelementptr inbounds double, ptr @table_{number}, <{o.lanes} x i32> {index}")
    given = f"{places} {here}, i32 8, {o.M} {o.flag(value=True)}, {o.V} poison"
    return o.let(f"call {o.V} @llvm.masked.gather.v{o.lanes}f64.v{o.lanes}p0({given})")


def _skip(o: Vectors, number: int, mask: str) -> None:
    o.branch_if_any(mask, f"rare_{number}", f"resumed_{number}")
    o.do(f"rare_{number}:")


def _resume(o: Vectors, number: int) -> None:
    o.do(f"br label %resumed_{number}")
    o.do(f"resumed_{number}:")


def _join(o: Vectors, number: int, a: str) -> str:
    before = f"resumed_{number - 1}" if number else "sample"
    return o.let(f"phi {o.V} [{a}, %rare_{number}], [zeroinitializer, %{before}]")


def _record(o: Vectors, number: int, a: str, n_recorded: int) -> None:
    value = o.let(f"select {o.M} %active, {o.V} {a}, {o.V} {o.number(float('nan'))}")
    time = o.let(f"mul i64 {o.let('sub i64 %k, %first')}, {n_recorded}")
    line = o.let(f"add i64 {time}, {number}")
    index = o.let(f"add i64 {o.let(f'mul i64 {line}, %n')}, %o")
    o.do(f"store {o.V} {value}, ptr {o.let(f'getelementptr inbounds double, ptr %tile, i64 {index}')}, align 8")
