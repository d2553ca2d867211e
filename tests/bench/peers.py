"""Who flies the step: each takes start and constants of some runs and gives a function (samples) -> final state."""

import operator
from collections.abc import Callable
from functools import partial

import numpy as np

from fddbench.blocks import kernel
from tests.bench import limit, step
from tests.bench.absent import need
from tests.bench.plain import Run
from tests.bench.translate import translate, transplanted

Fly = Callable[[int], np.ndarray]
Make = Callable[[np.ndarray, np.ndarray], Fly]


def engine(state: np.ndarray, constants: np.ndarray, *, noise: bool = False, lanes: int | None = None) -> Fly:
    """Ours."""
    if noise:
        compiled = kernel.build(step.noisy_program(), consumers=(1, 2), backend="llvm", lanes=lanes)
    else:
        compiled = kernel.build(step.quiet_program(), backend="llvm", lanes=lanes)
    n = state.shape[1]
    where = kernel.Addresses(key=99, run=np.arange(n), flight=1, scenario=2)

    def fly(samples: int) -> np.ndarray:
        return compiled.fly(state, constants, np.full(n, samples), where, first=0, end=samples).state

    return fly


def hand_written(
    state: np.ndarray, constants: np.ndarray, *, noise: bool = False, lanes: int = 8, exact: bool = False
) -> Fly:
    """C++ with vector types: the limit."""
    function = limit.build(noise=noise, lanes=lanes, exact=exact)
    after = np.empty_like(state)
    n = state.shape[1]

    def fly(samples: int) -> np.ndarray:
        function(n, 0, samples, state.ctypes.data, after.ctypes.data, constants.ctypes.data, 99)
        return after

    return fly


def numpy(state: np.ndarray, constants: np.ndarray) -> Fly:
    """The step function as it stands, on arrays over all runs."""

    def fly(samples: int) -> np.ndarray:
        after = state
        for k in range(samples):
            after = step.quiet(after, constants, np.float64(k))["state"]
        return after

    return fly


def one_by_one(state: np.ndarray, constants: np.ndarray) -> Fly:
    """One run after the other in NumPy."""

    def fly(samples: int) -> np.ndarray:
        found = np.empty_like(state)
        for i in range(state.shape[1]):
            run, x = Run(constants[:, i]), state[:, i]
            for k in range(samples):
                x = run.step(x, k)
            found[:, i] = x
        return found

    return fly


def solve_ivp(state: np.ndarray, constants: np.ndarray) -> Fly:
    """One run after the other, the plant integrated by SciPy from sample to sample, as its defaults are."""
    from scipy.integrate import solve_ivp as solve

    def fly(samples: int) -> np.ndarray:
        found = np.empty_like(state)
        for i in range(state.shape[1]):
            run, x = Run(constants[:, i]), state[:, i]
            for k in range(samples):
                f = run.plant(x, k)
                run.after[:4] = solve(lambda _, y, f=f: f(y), (0.0, step.DT), x[:4]).y[:, -1]
                x = run.after
            found[:, i] = x
        return found

    return fly


def python_control(state: np.ndarray, constants: np.ndarray) -> Fly:
    """One run after the other as a nonlinear sampled system of python-control."""
    control = need("control")
    names, n = list(step.STATES.names), len(state)

    def fly(samples: int) -> np.ndarray:
        found = np.empty_like(state)
        for i in range(state.shape[1]):
            run = Run(constants[:, i])
            system = control.nlsys(
                lambda t, x, u, params, run=run: run.step(x, round(t / step.DT)), None,
                inputs=["u"], outputs=names, states=names, dt=step.DT,
            )  # fmt: skip
            time_s = np.arange(samples + 1) * step.DT
            answer = control.input_output_response(system, time_s, np.zeros(samples + 1), state[:, i])
            found[:, i] = answer.states.reshape(n, -1)[:, -1]
        return found

    return fly


def heyoka(state: np.ndarray, constants: np.ndarray) -> Fly:
    """A compiled function of the step over all runs, called once a sample."""
    hy = need("heyoka")

    def smaller(a, b):
        return hy.select(hy.lt(a, b), a, b)

    def larger(a, b):
        return hy.select(hy.gt(a, b), a, b)

    table = {
        "add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv, "neg": operator.neg,
        "min": smaller, "max": larger, "abs": lambda a: larger(a, -a), "sqrt": hy.sqrt, "sin": hy.sin,
        "lt": hy.lt, "le": hy.lte, "eq": hy.eq, "ne": hy.neq, "select": hy.select, "number": lambda a: a * 1.0,
        "and": lambda a, b: hy.logical_and([a, b]), "or": lambda a, b: hy.logical_or([a, b]),
    }  # fmt: skip
    x = [hy.expression(f"x{j}") for j in range(len(state))]
    leaves = {"state": lambda j: x[j], "constants": lambda j: hy.par[j], "sample": lambda _: hy.time}
    rows = translate(step.quiet_program(), lambda name, j: leaves[name](j), table)
    rows = [hy.expression(row) if isinstance(row, float) else row for row in rows]
    compiled = hy.cfunc(rows, x, force_avx512=True)
    parameters, time_s = np.ascontiguousarray(constants), np.empty(state.shape[1])

    def fly(samples: int) -> np.ndarray:
        now, after = np.array(state), np.empty_like(state)
        for k in range(samples):
            time_s[:] = k
            compiled(inputs=now, pars=parameters, time=time_s, outputs=after)
            now, after = after, now
        return now

    return fly


def jax(state: np.ndarray, constants: np.ndarray) -> Fly:
    """``jit(vmap(lax.scan))`` of the step's own source with jax.numpy under it, float64, CPU: the fastest of three ways."""
    module = need("jax")
    module.config.update("jax_enable_x64", True)
    module.config.update("jax_platforms", "cpu")
    jnp, quiet = module.numpy, transplanted(module.numpy)

    @partial(module.jit, static_argnums=2)
    def scan(start, fixed, samples):
        def one(x, c):
            def body(rows, k):
                return quiet(rows[:, np.newaxis], c[:, np.newaxis], k)["state"][:, 0], None

            return module.lax.scan(body, x, jnp.arange(samples, dtype=float))[0]

        return module.vmap(one, (1, 1), 1)(start, fixed)

    start, fixed = jnp.asarray(state), jnp.asarray(constants)
    return lambda samples: np.asarray(module.block_until_ready(scan(start, fixed, samples)))
