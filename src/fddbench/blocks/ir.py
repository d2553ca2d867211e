"""LLVM text of a kernel: a loop over blocks of W cases around a loop over samples, random numbers drawn inside."""

from dataclasses import dataclass, field

import numpy as np

from fddbench.blocks.emit import Vectors
from fddbench.blocks.graph import Graph
from fddbench.blocks.philox import PER_DRAW, box_muller
from fddbench.blocks.program import Program, depends_only_on, expand
from fddbench.blocks.traced import Traced

__all__ = ["Spec", "with_draws", "write"]

_M0, _M1, _W0, _W1 = 0xD2511F53, 0xCD9E8D57, 0x9E3779B9, 0xBB67AE85
_NAN = float("nan")


@dataclass(frozen=True, kw_only=True)
class Spec:
    """What a kernel is made of.

    Attributes
    ----------
    program : Program
        In primitives, with ``uniforms`` in place of ``normals`` (`with_draws`).
    streams : tuple of (int, str)
        Consumer number of each draw and whose stream it takes, ``flight`` or ``scenario``.
    recorded : tuple of str
        Outputs stored at every sample.
    """

    program: Program
    streams: tuple[tuple[int, str], ...]
    recorded: tuple[str, ...] = ()


def with_draws(program: Program) -> Program:
    """The program in primitives, its normals made of uniform numbers by `philox.box_muller`."""

    def normal(graph: Graph, name: str, row: int) -> int | None:
        if name != "normals":
            return None
        draw = row // PER_DRAW * PER_DRAW
        ids = np.array([[graph.input("uniforms", draw + j)] for j in range(PER_DRAW)], dtype=np.int64)
        return int(box_muller(Traced(graph, ids)).ids[row - draw, 0])

    return expand(program, normal)


@dataclass
class _Body:
    """State of the writer of one kernel."""

    spec: Spec
    out: Vectors
    once: list[bool]
    slots: dict[int, int] = field(default_factory=dict)
    values: dict[int, str] = field(default_factory=dict)
    words: dict[int, list[str]] = field(default_factory=dict)
    state_loaded: dict[int, str] = field(default_factory=dict)

    @property
    def n_state(self) -> int:
        return max(self.spec.program.inputs.get("state", 0), 0)

    def slot(self, number: int) -> str:
        """Address of a vector in the workspace."""
        o = self.out
        return o.let(f"getelementptr inbounds {o.V}, ptr %work, i64 {number}")

    def load_slot(self, number: int) -> str:
        o = self.out
        return o.let(f"load {o.V}, ptr {self.slot(number)}, align {8 * o.lanes}")

    def store_slot(self, number: int, value: str) -> None:
        o = self.out
        o.do(f"store {o.V} {value}, ptr {self.slot(number)}, align {8 * o.lanes}")


def slots_needed(spec: Spec) -> int:
    """Vectors of workspace that a kernel needs at most."""
    return spec.program.inputs.get("state", 0) + len(spec.program.nodes) + 8


def write(spec: Spec, lanes: int, *, rounds: bool) -> str:
    """LLVM module with one function ``fly``.

    Its arguments: padded number of cases, first and last sample, key, then addresses of state (n_state, n), constants
    (n_constant, n), samples to fly (n,) int64, run, flight and scenario words (n,) uint64, tile (n_time, n_recorded, n)
    and workspace.
    """
    out = Vectors(lanes, rounds=rounds)
    body = _Body(spec, out, depends_only_on(spec.program, {"constants"}))
    names = ("state", "constants", "samples", "run", "flight", "scenario", "tile", "work")
    pointers = ", ".join(f"ptr noalias noundef %{name}" for name in names)
    out.do(f"define void @fly(i64 %n, i64 %first, i64 %end, i64 %key, {pointers}) nounwind {{\nentry:")
    _keys(out)
    out.do("br label %block")
    out.do("block:")
    out.do("%o = phi i64 [0, %entry], [%o_next, %next_block]")
    out.do(f"%samples_at = getelementptr inbounds i64, ptr %samples, i64 %o")
    out.do(f"%lasts = load {out.I}, ptr %samples_at, align 8")
    firsts = out.spread("i64", "%first")
    out.do(f"%flying = icmp slt {out.I} {firsts}, %lasts")
    _branch_if_any(out, "%flying", "prologue", "next_block")
    out.do("prologue:")
    _copy_state(body)
    _prologue(body)
    out.do("br label %sample")
    out.do("sample:")
    out.do("%k = phi i64 [%first, %prologue_end], [%k_next, %more]")
    out.do(f"%active = phi {out.M} [%flying, %prologue_end], [%still, %more]")
    _sample(body)
    _ending(body)
    out.do("next_block:")
    out.do(f"%o_next = add i64 %o, {lanes}")
    out.do("%blocks_left = icmp slt i64 %o_next, %n")
    out.do("br i1 %blocks_left, label %block, label %done")
    out.do("done:")
    out.do("ret void\n}")
    return "\n".join(out.lines) + "\n" + out.declarations() + "\n"


def _branch_if_any(out: Vectors, mask: str, yes: str, no: str) -> None:
    bits = out.let(f"bitcast {out.M} {mask} to i{out.lanes}")
    some = out.let(f"icmp ne i{out.lanes} {bits}, 0")
    out.do(f"br i1 {some}, label %{yes}, label %{no}")


def _keys(out: Vectors) -> None:
    """Both key words of the ten rounds."""
    out.do("%key_low = and i64 %key, 4294967295")
    out.do("%key_high = lshr i64 %key, 32")
    for j in range(10):
        for name, step in (("low", _W0), ("high", _W1)):
            out.do(f"%{name}_{j}_wide = add i64 %key_{name}, {j * step}")
            out.do(f"%{name}_{j} = and i64 %{name}_{j}_wide, 4294967295")


def _row_loop(body: _Body, label: str, rows: int, after: str, came_from: str, statement: str) -> None:
    """Loop over state rows: `statement` sees %row_<label>, %here_<label> (work) and %there_<label> (memory)."""
    o = body.out
    o.do(f"br label %{label}")
    o.do(f"{label}:")
    o.do(f"%row_{label} = phi i64 [0, %{came_from}], [%row_{label}_next, %{label}]")
    o.do(f"%here_{label} = getelementptr inbounds {o.V}, ptr %work, i64 %row_{label}")
    o.do(f"%index_{label} = mul i64 %row_{label}, %n")
    o.do(f"%place_{label} = add i64 %index_{label}, %o")
    o.do(f"%there_{label} = getelementptr inbounds double, ptr %state, i64 %place_{label}")
    for line in statement.splitlines():
        o.do(line)
    o.do(f"%row_{label}_next = add i64 %row_{label}, 1")
    o.do(f"%more_{label} = icmp slt i64 %row_{label}_next, {rows}")
    o.do(f"br i1 %more_{label}, label %{label}, label %{after}")


def _copy_state(body: _Body) -> None:
    o, align = body.out, 8 * body.out.lanes
    _row_loop(body, "copy", body.n_state, "prologue_end", "prologue",
              f"%copied = load {o.V}, ptr %there_copy, align 8\nstore {o.V} %copied, ptr %here_copy, align {align}")  # fmt: skip
    o.do("prologue_end:")


def _prologue(body: _Body) -> None:
    """What depends on the constants alone, computed once a block and kept in the workspace."""
    o, nodes = body.out, body.spec.program.nodes
    used = {a for j, node in enumerate(nodes) if not body.once[j] for a in node.arguments}
    used |= {node for rows in body.spec.program.outputs.values() for node in rows}
    next_slot, names = body.n_state, {}
    for j, node in enumerate(nodes):
        if not body.once[j] or node.op in {"literal", "flag"}:
            continue
        if node.op == "input":
            index = o.let(f"mul i64 %n, {node.value[1]}")  # type: ignore[index]
            place = o.let(f"getelementptr inbounds double, ptr %constants, i64 {o.let(f'add i64 {index}, %o')}")
            names[j] = o.let(f"load {o.V}, ptr {place}, align 8")
        else:
            names[j] = o.operation(node.op, *(_operand(body, names, a) for a in node.arguments))
        if j in used:
            value = names[j] if not _boolean(node.op) else o.operation("number", names[j])
            body.slots[j] = next_slot
            body.store_slot(next_slot, value)
            next_slot += 1
    for name in ("run", "flight", "scenario"):
        place = o.let(f"getelementptr inbounds i64, ptr %{name}, i64 %o")
        o.do(f"%{name}_words = load {o.I}, ptr {place}, align 8")


def _boolean(op: str) -> bool:
    from fddbench.blocks.operations import OPERATIONS  # noqa: PLC0415

    return OPERATIONS[op].result == "b"


def _operand(body: _Body, names: dict[int, str], node: int) -> str:
    op, _, value = body.spec.program.nodes[node]
    if op == "literal":
        return body.out.number(value)  # type: ignore[arg-type]
    return body.out.flag(bool(value)) if op == "flag" else names[node]


def _order(program: Program, known: dict[int, int]) -> list[int]:
    """Nodes depth first from the outputs, so that what is computed is used soon."""
    seen, order = set[int](), list[int]()
    for root in [node for rows in program.outputs.values() for node in rows]:
        stack = [(root, False)]
        while stack:
            node, ready = stack.pop()
            if ready:
                order.append(node)
            elif node not in seen:
                seen.add(node)
                stack.append((node, True))
                arguments = () if node in known else program.nodes[node].arguments
                stack.extend((a, False) for a in reversed(arguments) if a not in seen)
    return order


def _sample(body: _Body) -> None:
    """One sample of the step; new state goes to the workspace as soon as it is known."""
    o, program = body.out, body.spec.program
    o.do("%k_word = and i64 %k, 4294967295")
    o.do("%time = sitofp i64 %k to double")
    o.do("; step")
    for j in _order(program, body.slots):
        _value(body, j)
    state = program.outputs["state"]
    values = [_value(body, node) for node in state]
    for row, value in enumerate(values):
        body.store_slot(row, value)
    _record(body)


def _value(body: _Body, j: int) -> str:
    """Name of the value of a node in the loop over samples, written when first asked for."""
    op, arguments, value = body.spec.program.nodes[j]
    o = body.out
    if op in {"literal", "flag"}:
        return _operand(body, {}, j)
    if j in body.values:
        return body.values[j]
    if j in body.slots:
        name = body.load_slot(body.slots[j])
        if _boolean(op):
            name = o.operation("ne", name, o.number(0.0))
    elif op == "input":
        name = _input(body, *value)  # type: ignore[misc]
    else:
        name = o.operation(op, *(_value(body, a) for a in arguments))
    body.values[j] = name
    return name


def _input(body: _Body, name: str, row: int) -> str:
    o = body.out
    if name == "state":
        return body.load_slot(row)
    if name == "sample":
        return o.spread("double", "%time")
    draw, word = divmod(row, PER_DRAW)
    if draw not in body.words:
        body.words[draw] = _philox(o, *body.spec.streams[draw])
    integer = body.words[draw][word]
    return o.operation("mul", o.operation("add", o.whole(integer), o.number(0.5)), o.number(2.0**-32))


def _philox(o: Vectors, consumer: int, stream: str) -> list[str]:
    """Four random words of every lane: Philox4x32-10 of (sample, consumer, run, stream)."""
    x0, x1, x2, x3 = o.spread("i64", "%k_word"), o.integer(consumer), "%run_words", f"%{stream}_words"
    low = o.integer(0xFFFFFFFF)
    for j in range(10):
        p0, p1 = o.let(f"mul {o.I} {x0}, {o.integer(_M0)}"), o.let(f"mul {o.I} {x2}, {o.integer(_M1)}")
        mixed = []
        for product, other, name in ((p1, x1, "low"), (p0, x3, "high")):
            high = o.let(f"lshr {o.I} {product}, {o.integer(32)}")
            both = o.let(f"xor {o.I} {high}, {other}")
            mixed.append(o.let(f"xor {o.I} {both}, {o.spread('i64', f'%{name}_{j}')}"))
        x1, x3 = (o.let(f"and {o.I} {product}, {low}") for product in (p1, p0))
        x0, x2 = mixed
    return [x0, x1, x2, x3]


def _record(body: _Body) -> None:
    """Store the recorded outputs of this sample, not-a-number where a flight is over."""
    o, program = body.out, body.spec.program
    rows = [node for name in body.spec.recorded for node in program.outputs[name]]
    if not rows:
        return
    step = o.let(f"mul i64 {o.let('sub i64 %k, %first')}, {len(rows)}")
    for number, node in enumerate(rows):
        value = o.let(f"select {o.M} %active, {o.V} {_value(body, node)}, {o.V} {o.number(_NAN)}")
        line = o.let(f"mul i64 {o.let(f'add i64 {step}, {number}')}, %n")
        place = o.let(f"getelementptr inbounds double, ptr %tile, i64 {o.let(f'add i64 {line}, %o')}")
        o.do(f"store {o.V} {value}, ptr {place}, align 8")


def _ending(body: _Body) -> None:
    """Write back the state of the lanes whose flight is over, and go on while there are others."""
    o = body.out
    o.do("%k_next = add i64 %k, 1")
    over = o.let(f"icmp sle {o.I} %lasts, {o.spread('i64', '%k_next')}")
    finished = body.spec.program.outputs.get("finished")
    if finished:
        over = o.let(f"or {o.M} {over}, {o.operation('ne', _value(body, finished[0]), o.number(0.0))}")
    o.do(f"%ending = and {o.M} %active, {over}")
    o.do("br label %sample_end")
    o.do("sample_end:")
    _branch_if_any(o, "%ending", "landing", "go_on")
    o.do("landing:")
    now = o.let(f"load {o.I}, ptr %samples_at, align 8")
    counts = o.let(f"select {o.M} %ending, {o.I} {o.spread('i64', '%k_next')}, {o.I} {now}")
    o.do(f"store {o.I} {counts}, ptr %samples_at, align 8")
    _write_back(body, "land", "%ending", "landed", "landing")
    o.do("landed:")
    o.do(f"%not_ending = xor {o.M} %ending, {o.flag(value=True)}")
    o.do(f"%others = and {o.M} %active, %not_ending")
    _branch_if_any(o, "%others", "go_on", "next_block")
    o.do("go_on:")
    o.do(f"%still = phi {o.M} [%active, %sample_end], [%others, %landed]")
    o.do("%last_sample = icmp sge i64 %k_next, %end")
    o.do("br i1 %last_sample, label %pause, label %more")
    o.do("more:")
    o.do("br label %sample")
    o.do("pause:")
    _write_back(body, "keep", "%still", "next_block", "pause")


def _write_back(body: _Body, label: str, mask: str, after: str, came_from: str) -> None:
    o, align = body.out, 8 * body.out.lanes
    _row_loop(body, label, body.n_state, after, came_from,
              f"%new_{label} = load {o.V}, ptr %here_{label}, align {align}\n"
              f"%old_{label} = load {o.V}, ptr %there_{label}, align 8\n"
              f"%chosen_{label} = select {o.M} {mask}, {o.V} %new_{label}, {o.V} %old_{label}\n"
              f"store {o.V} %chosen_{label}, ptr %there_{label}, align 8")  # fmt: skip


