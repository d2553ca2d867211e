"""LLVM text of a kernel: a loop over blocks of W cases around a loop over samples."""

from collections.abc import Iterable
from typing import Any

from fddbench.blocks.plan import Instruction, Plan, Repeated
from fddbench.blocks.targets.llvm import memory, random
from fddbench.blocks.targets.llvm.arithmetic import operation
from fddbench.blocks.targets.llvm.writer import Vectors

__all__ = ["write"]

# with a frame pointer LLVM can align the stack to whole vectors; else every one put aside straddles two cache lines (8 %)
_ATTRIBUTES = 'nounwind "frame-pointer"="all"'
_POINTERS = ("state", "constants", "samples", "run", "flight", "scenario", "tile", "work")


def write(plan: Plan, lanes: int, *, rounds: bool) -> str:
    """LLVM module with the functions ``fly`` and ``slots``, the number of vectors of workspace that it needs.

    Arguments: padded number of cases n, first sample, sample to stop before, key; then addresses of state
    (n_state, n), constants (n_constant, n), samples to fly (n,), run, flight and scenario words (n,), the tile
    (n_time, n_recorded, n) and the workspace. Numbers are float64 and int64, the words uint64.
    """
    o = Vectors(lanes, rounds=rounds)
    text = memory.table(plan.slots, plan.n_recorded)
    pointers = ", ".join(f"ptr noalias noundef %{name}" for name in _POINTERS)
    o.do(f"define void @fly(i64 %n, i64 %first, i64 %end, i64 %key, {pointers}) {_ATTRIBUTES} {{")
    o.do("entry:")
    random.keys(o)
    o.do("br label %block")
    _block(o, plan)
    _written(o, text, plan.prologue, {})
    o.do("br label %sample")
    o.do("sample:")
    o.do("%k = phi i64 [%first, %prologue], [%k_next, %more]")
    o.do(f"%active = phi {o.M} [%flying, %prologue], [%still, %more]")
    o.do("%k_word = and i64 %k, 4294967295")
    o.do("%time = sitofp i64 %k to double")
    registers = _written(o, text, plan.sample, {})
    _ending(o, [registers[register] for register in plan.finished], plan)
    o.do("next_block:")
    o.do(f"%o_next = add i64 %o, {lanes}")
    o.do("%blocks_left = icmp slt i64 %o_next, %n")
    o.do("br i1 %blocks_left, label %block, label %done")
    o.do("done:")
    o.do("ret void")
    o.do("}")
    for number, repeated in enumerate(plan.repeats):
        _repeat(o, text, number, repeated)
    size = f"define i64 @slots() nounwind {{\n  ret i64 {plan.slots}\n}}"
    return "\n".join([*_tables(o, plan), *o.lines, size, *_declarations(o, plan), ""])


def _written(
    o: Vectors, text: dict[str, memory.Line], instructions: Iterable[Instruction], registers: dict[int, Any]
) -> dict[int, Any]:
    """Write instructions one after the other; names of the registers, added to those known."""
    for op, result, arguments, value in instructions:
        line, names = text[op], [registers[a] for a in arguments]
        made = o.let(line.format(*names, V=o.V, M=o.M, W=o.lanes)) if isinstance(line, str) else line(o, value, *names)
        registers[result] = made
    return registers


def _repeat(o: Vectors, text: dict[str, memory.Line], number: int, repeated: Repeated) -> None:
    """Function that runs a body `count` times over the vectors from ``%work`` on."""
    o.do(f"define internal void @repeat_{number}(ptr noundef %work) {_ATTRIBUTES} {{")
    o.do("entry:")
    registers = _written(o, text, repeated.before, {})
    o.do("br label %each")
    o.do("each:")
    o.do("%turn = phi i64 [0, %entry], [%turn_next, %each]")
    _written(o, text, repeated.each, registers)
    o.do("%turn_next = add i64 %turn, 1")
    o.do(f"%turns_left = icmp slt i64 %turn_next, {repeated.count}")
    o.do("br i1 %turns_left, label %each, label %done")
    o.do("done:")
    o.do("ret void")
    o.do("}")


def _tables(o: Vectors, plan: Plan) -> list[str]:
    """Constant memory."""
    return [
        f"@table_{number} = private unnamed_addr constant [{len(table)} x double] "
        f"[{', '.join(map(o.scalar, table.values.tolist()))}], align 64"
        for number, table in enumerate(plan.tables)
    ]


def _declarations(o: Vectors, plan: Plan) -> list[str]:
    """Intrinsics used."""
    names = ("fabs", "sqrt", "floor", "nearbyint")
    lines = [f"declare {o.V} @llvm.{name}.v{o.lanes}f64({o.V})" for name in names]
    if plan.tables:
        given = f"<{o.lanes} x ptr>, i32, {o.M}, {o.V}"
        lines.append(f"declare {o.V} @llvm.masked.gather.v{o.lanes}f64.v{o.lanes}p0({given})")
    return lines


def _block(o: Vectors, plan: Plan) -> None:
    """Start of a block of cases at ``%o``: who flies, their state copied into the workspace, their random words."""
    o.do("block:")
    o.do("%o = phi i64 [0, %entry], [%o_next, %next_block]")
    o.do("%samples_at = getelementptr inbounds i64, ptr %samples, i64 %o")
    o.do(f"%lasts = load {o.I}, ptr %samples_at, align 8")
    o.do(f"%flying = icmp slt {o.I} {o.spread('i64', '%first')}, %lasts")
    o.branch_if_any("%flying", "start", "next_block")
    o.do("start:")
    lines = (f"%copied = load {o.V}, ptr %there_copy, align 8", f"store {o.V} %copied, ptr %here_copy, align {o.bytes}")
    _state_loop(o, plan.n_state, "copy", lines, before="start", after="prologue")
    o.do("prologue:")
    for name in ("run", "flight", "scenario"):
        place = o.let(f"getelementptr inbounds i64, ptr %{name}, i64 %o")
        o.do(f"%{name}_words = load {o.I}, ptr {place}, align 8")


def _ending(o: Vectors, finished: list[str], plan: Plan) -> None:
    """End of a sample: write back the lanes whose flight is over, and go on while there are others."""
    o.do("%k_next = add i64 %k, 1")
    over = o.let(f"icmp sle {o.I} %lasts, {o.spread('i64', '%k_next')}")
    for number in finished:
        over = o.let(f"or {o.M} {over}, {operation(o, 'ne', number, o.number(0.0))}")
    o.do(f"%ending = and {o.M} %active, {over}")
    sample = o.block
    o.branch_if_any("%ending", "landing", "go_on")
    o.do("landing:")
    now = o.let(f"load {o.I}, ptr %samples_at, align 8")
    counts = o.let(f"select {o.M} %ending, {o.I} {o.spread('i64', '%k_next')}, {o.I} {now}")
    o.do(f"store {o.I} {counts}, ptr %samples_at, align 8")
    _write_back(o, plan, "land", "%ending", before="landing", after="landed")
    o.do("landed:")
    o.do(f"%others = and {o.M} %active, {operation(o, 'not', '%ending')}")
    o.branch_if_any("%others", "go_on", "next_block")
    o.do("go_on:")
    o.do(f"%still = phi {o.M} [%active, %{sample}], [%others, %landed]")
    o.do("%paused = icmp sge i64 %k_next, %end")
    o.do("br i1 %paused, label %pause, label %more")
    o.do("more:")
    o.do("br label %sample")
    o.do("pause:")
    _write_back(o, plan, "keep", "%still", before="pause", after="next_block")


def _write_back(o: Vectors, plan: Plan, label: str, mask: str, *, before: str, after: str) -> None:
    """State of some lanes from the workspace to memory."""
    lines = (
        f"%new_{label} = load {o.V}, ptr %here_{label}, align {o.bytes}",
        f"%old_{label} = load {o.V}, ptr %there_{label}, align 8",
        f"%chosen_{label} = select {o.M} {mask}, {o.V} %new_{label}, {o.V} %old_{label}",
        f"store {o.V} %chosen_{label}, ptr %there_{label}, align 8",
    )
    _state_loop(o, plan.n_state, label, lines, before=before, after=after)


def _state_loop(o: Vectors, rows: int, label: str, lines: tuple[str, ...], *, before: str, after: str) -> None:
    """Loop over state rows; the lines see ``%here_<label>`` in the workspace and ``%there_<label>`` in memory."""
    if not rows:
        o.do(f"br label %{after}")
        return
    o.do(f"br label %{label}")
    o.do(f"{label}:")
    o.do(f"%row_{label} = phi i64 [0, %{before}], [%next_{label}, %{label}]")
    o.do(f"%here_{label} = getelementptr inbounds {o.V}, ptr %work, i64 %row_{label}")
    o.do(f"%index_{label} = mul i64 %row_{label}, %n")
    o.do(f"%place_{label} = add i64 %index_{label}, %o")
    o.do(f"%there_{label} = getelementptr inbounds double, ptr %state, i64 %place_{label}")
    for line in lines:
        o.do(line)
    o.do(f"%next_{label} = add i64 %row_{label}, 1")
    o.do(f"%more_{label} = icmp slt i64 %next_{label}, {rows}")
    o.do(f"br i1 %more_{label}, label %{label}, label %{after}")
