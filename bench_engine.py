"""Speed of the engine on a step of about 1100 floating-point operations (not for merge)."""
import os, sys, time, pathlib, tempfile
import numpy as np
from fddbench.blocks import functions as F, llvm, ir, kernel as K
from fddbench.blocks.layout import Layout
from fddbench.blocks.linear import affine, product, column, total, largest
from fddbench.blocks.program import trace, expand

rng = np.random.default_rng(1)
DT = 0.01
STATES = Layout(x=4, act=13, gust=2, obs=5, flt=0, thr=0, count=3, latched=3, alarm=0, peak=0, e=3)
CONST = Layout(limits=13, bias=3, amplitude=0, omega=0, onset=0, last=0, mask=3, cmd=0, scale=0, mknots=6, mvalues=6, sigma=0)
A = [rng.normal(size=(4, 4)) * s for s in (0.5, 0.1, 0.1)]
A[0] -= 1.5 * np.eye(4)
Bm = [rng.normal(size=(4, 13)) * s for s in (0.2, 0.05, 0.05)]
mask = rng.random((4, 13)) < 0.25
Bm = [np.where(mask, 0, b) for b in Bm]
AT, BT = column(np.stack(A)), column(np.stack(Bm))
K1 = rng.normal(size=(13, 3)) * 0.1
TAU = column(np.linspace(15, 40, 13))
Ao = column(rng.normal(size=(4, 4)) * 0.1 - np.eye(4)); Bo = column(rng.normal(size=(4, 3)) * 0.2); Lo = column(rng.normal(size=(4, 1)))

def step(state, constants, normals, sample):
    s, c = STATES.unpack(state), CONST.unpack(constants)
    t = sample * DT
    phi = s.x[3]
    noise = normals[:3] * 0.01
    faulty = np.where(sample >= c.onset, c.amplitude * F.sin(c.omega * (t - c.onset * DT)), 0.0)
    sensors = np.stack([s.x[2] + noise[j] + c.bias[j] * 0.01 + c.mask[j] * faulty for j in range(3)])
    low = np.minimum(np.minimum(np.maximum(sensors[0], sensors[1]), np.maximum(sensors[1], sensors[2])), np.maximum(sensors[0], sensors[2]))
    voted = low
    command = F.interpolate(t, c.mknots, c.mvalues) * c.cmd
    feedback = np.stack([voted, phi + normals[3] * 0.001, s.x[0]])
    demand = product(column(K1), feedback) + command * 0.1
    rate = np.minimum(np.maximum((demand - s.act) * TAU, -c.limits * 4), c.limits * 4)
    act = np.minimum(np.maximum(s.act + rate * DT, -c.limits), c.limits)
    gust = np.stack([s.gust[0] * 0.98 + normals[4] * c.sigma, s.gust[1] * 0.97 + normals[5] * c.sigma + s.gust[0] * 0.02])
    rho = np.stack([s.x[0] * 0.1 * c.scale, s.x[1] * 0.1])
    Am, Bb = affine(AT, rho), affine(BT, rho)
    drive = product(Bb, act) + np.stack([gust[0] * 0.1, gust[1] * 0.1, gust[0] * 0.05, gust[1] * 0.0])
    def f(x): return product(Am, x) + drive
    x = s.x
    k1 = f(x); k2 = f(x + 0.5 * DT * k1); k3 = f(x + 0.5 * DT * k2); k4 = f(x + DT * k3)
    xn = x + (DT / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    # sliding-mode observer
    meas = np.stack([voted, feedback[1], normals[6] * 0.01])
    z = s.obs[:4]
    err = voted - z[2]
    g = s.obs[4]
    for _ in range(3):
        h = np.abs(g) + 0.1
        g = g - (h * h * g - err) / (3.0 * h * h + 0.5)
    sig = err / (np.abs(err) + 0.01)
    zn = z + DT * (product(Ao, z) + product(Bo, meas) + product(Lo, err[np.newaxis]) + sig * 0.2)
    obs = np.concatenate([zn, g[np.newaxis]])
    flt = s.flt * 0.95 + 0.05 * np.abs(err)
    thr = s.thr * 0.999 + 0.001 * (1.0 + np.sqrt(gust[0] * gust[0] + gust[1] * gust[1]))
    dev = np.abs(sensors - voted)
    over = dev > thr * 0.5
    count = np.where(over, s.count + 1.0, np.maximum(s.count - 1.0, 0.0))
    latched = np.where((count > 30.0) & (sample < c.last), 1.0, s.latched)
    e = s.e * 0.9 + dev * dev
    n = total(latched)
    alarm = np.where((s.alarm == 0.0) & (n > 0.0), sample, s.alarm)
    peak = np.where(sample < c.last, np.maximum(s.peak, flt / thr), s.peak)
    return {"state": STATES.pack(x=xn, act=act, gust=gust, obs=obs, flt=flt, thr=thr, count=count, latched=latched, alarm=alarm, peak=peak, e=e),
            "signals": np.concatenate([xn, sensors, voted[None]])}

def data(n):
    r = np.random.default_rng(3)
    state = np.zeros((STATES.size, n)); state[:4] = r.normal(size=(4, n)) * 0.1
    const = r.normal(size=(CONST.size, n)) * 0.1
    i = CONST.index
    const[i["limits"]] = 5 + r.random((13, n)); const[i["onset"]] = 500; const[i["last"]] = 6000; const[i["mask"]] = np.array([1, 0, 0])[:, None]
    const[i["mknots"]] = np.array([0, 1, 2, 20, 21, 22.])[:, None]; const[i["scale"]] = 1; const[i["omega"]] = 6; const[i["sigma"]] = 0.1
    return state, const

if __name__ == "__main__":
    t0 = time.perf_counter()
    p = trace(step, state=STATES.size, constants=CONST.size, normals=8, sample=0)
    t1 = time.perf_counter()
    print("nodes", len(p.nodes), "trace s", round(t1 - t0, 4))
    from fddbench.blocks.program import depends_only_on
    from fddbench.blocks.operations import OPERATIONS
    e = expand(p); once = depends_only_on(e, {"constants"})
    fl = sum(1 for j, nd in enumerate(e.nodes) if not once[j] and nd.arguments)
    print("ops per step without noise", fl, "const", CONST.size, "state", STATES.size)
    n, T = 64, 6000
    state, const = data(n)
    ad = K.Addresses(key=99, run=np.arange(n), flight=1, scenario=2)
    for tgt, lanes in ((("host", 8), ("host", 16), ("haswell", 8), ("haswell", 16), ("nehalem", 4)) if len(sys.argv) < 2 else (("host", int(sys.argv[1])),)):
        with tempfile.TemporaryDirectory() as d:
            os.environ["FDDBENCH_CACHE"] = d
            t0 = time.perf_counter()
            kk = K.build(p, consumers=(1, 2), target=tgt, lanes=lanes)
            t1 = time.perf_counter()
            m = llvm.machine(tgt)
            c0 = time.perf_counter(); obj = llvm.compile_object(kk.text, m); c1 = time.perf_counter()
            l0 = time.perf_counter(); llvm.load(kk.text, m); l1 = time.perf_counter()
        best = []
        for _ in range(5):
            c = time.process_time(); r = kk.fly(state, const, np.full(n, T), ad, first=0, end=T); best.append(time.process_time() - c)
        print(tgt, lanes, "M/s best/med", round(n * T / min(best) / 1e6, 2), round(n * T / sorted(best)[2] / 1e6, 2), "build s", round(t1 - t0, 3), "compile", round(c1 - c0, 3), "cached load", round(l1 - l0, 4), "obj kB", len(obj) // 1000, np.isfinite(r.state).all())
