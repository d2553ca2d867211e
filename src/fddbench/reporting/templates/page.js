(() => {
'use strict';
const D = JSON.parse(document.getElementById('data').textContent);
const $ = (s, e = document) => [...e.querySelectorAll(s)];
const esc = t => String(t).replace(/[&<>"']/g, c => `&#${c.charCodeAt(0)};`);
const matrix = document.getElementById('matrix'), form = document.getElementById('filter');
const NAMES = ['right in time', 'late', 'undecided', 'missed', 'healthy site declared', 'alarm before onset'];
const thin = n => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f');
const tick = v => Math.abs(v) >= 1e4 ? +(v / 1000).toPrecision(4) + 'k' : String(+v.toPrecision(3));
const state = {s: -1, d: -1, off: new Set(), bad: false, sort: false};

function axis(times, limit) {
  const known = [...times, limit].filter(t => t > 0);
  const lo = Math.min(...known), hi = Math.max(...known), log = hi > 20 * lo;
  const a = log ? lo / 1.6 : 0, b = log ? hi * 1.3 : hi * 1.1, ticks = [];
  if (log) {
    for (const steps of [[1, 2, 5], [1, 3], [1]]) {
      ticks.length = 0;
      for (let e = Math.floor(Math.log10(a)); e <= Math.ceil(Math.log10(b)); e++)
        for (const m of steps) { const v = +(m * 10 ** e).toPrecision(6); if (v >= a && v <= b) ticks.push(v); }
      if (ticks.length <= 8) break;
    }
  } else {
    const raw = b / 6, p = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 2.5, 5, 10].map(m => m * p).find(v => v >= raw * .999);
    for (let v = 0; v <= b * 1.0001; v += step) ticks.push(+v.toPrecision(6));
  }
  const x = v => { v = Math.min(Math.max(v, a), b); return log ? Math.log(v / a) / Math.log(b / a) : v / b; };
  return {a, log, ticks, x};
}
const R = v => Math.round(v * 10) / 10;
const yaxis = (list, L, W, Y, mid, what) => list.map(p => `<path class="gl" d="M${L} ${Y(p)}h${W}"/><text class="ts" x="41" y="${Y(p) + 4}" text-anchor="end">${100 * p}</text>`).join('') + `<text class="ts" x="11" y="${mid}" text-anchor="middle" transform="rotate(-90 11 ${mid})">${what}</text>`;
const xaxis = (A, X, L, W, B, what) => `<path class="ax" d="M${L} ${B}h${W}"/>` + A.ticks.map(v => `<path class="ax" d="M${X(v)} ${B}v4"/><text class="ts" x="${X(v)}" y="${B + 16}" text-anchor="middle">${tick(v)}</text>`).join('') + `<text class="ts" x="${L + W / 2}" y="${B + 31}" text-anchor="middle">${what}${A.log ? ', log' : ''}</text>`;
function curve(s, d) {
  const S = D.s[s], own = D.c[s].map((c, j) => [j, c]).filter(([j, c]) => c && c.i && !state.off.has(j));
  if (!own.length) return '';
  const L = 46, T = 10, W = 500, H = 205, A = axis(own.flatMap(([, c]) => c.i[0]), S.l || 0);
  const X = v => R(L + W * A.x(v)), Y = p => R(T + H * (1 - p)), B = T + H;
  let g = yaxis([0, .25, .5, .75, 1], L, W, Y, T + H / 2, 'flights [%]') + xaxis(A, X, L, W, B, 'time after onset [s]');
  if (S.l) g += `<path class="lim" d="M${X(S.l)} ${T}v${H}"/>`;
  const steps = (c, k) => { let p = `M${X(A.a)} ${Y(0)}`; c.i[0].forEach((t, i) => p += `H${X(t)}V${Y(k[i] / c.n)}`); return p + `H${X(c.i[6])}`; };
  own.sort((p, q) => (p[0] === d) - (q[0] === d)).forEach(([j, c]) => {
    const [t, k, , lo, hi, , end] = c.i;
    if (j === d && t.length && lo[0] !== null) {
      let up = '', down = '';
      t.forEach((v, i) => { const n = i + 1 < t.length ? t[i + 1] : end; up += ` ${X(v)},${Y(hi[i] / 1000)} ${X(n)},${Y(hi[i] / 1000)}`; down = ` ${X(n)},${Y(lo[i] / 1000)} ${X(v)},${Y(lo[i] / 1000)}` + down; });
      g += `<polygon class="b${j % 8}" points="${up + down}"/>`;
    }
    g += `<path class="s${j % 16}" d="${steps(c, k)}"/>`;
  });
  const me = D.c[s][d];
  if (me.i && me.i[2].some(k => k)) g += `<path class="wr" d="${steps(me, me.i[2])}"/>`;
  const key = own.sort((p, q) => p[0] - q[0]).map(([j]) => `<li><svg viewBox="0 0 28 9" aria-hidden="true"><path class="s${j % 16}" d="M0 5h28"/></svg>${esc(D.d[j])}</li>`).join('');
  return `<figure><h3>Found right, by time</h3><svg viewBox="0 0 560 250" role="img" aria-label="Share of all flights found by each time">${g}</svg><ul class="key">${key}</ul><figcaption>Share of all flown flights${me.i && me.i[0].length && me.i[3][0] !== null ? `, 95 % band of ${esc(D.d[d])} pointwise` : ''}; a wrong verdict is never taken out of n. Dashed: limit.${me.i && me.i[2].some(k => k) ? ' Dotted red: a healthy site declared, here.' : ''}${me.i && me.i[5] ? ` ${me.i[5]} more lost to an alarm before the onset.` : ''} A curve ends where the first open flight ends.</figcaption></figure>`;
}
function parts(name, labels, k, n, lo, hi, cls, what, foot) {
  const m = labels.length, W = Math.max(300, 52 * m + 50), w = (W - 56) / m, Y = p => R(8 + 96 * (1 - p));
  let g = yaxis([0, .5, 1], 46, W - 56, Y, 56, what);
  labels.forEach((v, i) => {
    const x = R(46 + w * (i + .5));
    if (n[i]) {
      if (lo[i] !== null) g += `<path class="e${cls}" d="M${x} ${Y(lo[i] / 100)}V${Y(hi[i] / 100)}"/>`;
      g += `<circle class="d${cls}" cx="${x}" cy="${Y(k[i] / n[i])}" r="3.5"><title>${k[i]} of ${n[i]}</title></circle>`;
    }
    g += `<text x="${x}" y="119" class="m z10">${esc(v)}</text><text class="ts m z10" x="${x}" y="133">${k[i]}/${n[i]}</text>`;
  });
  return `<figure><svg viewBox="0 0 ${W} 155" role="img" aria-label="${esc(what + ' by ' + name)}">${g}<text x="${46 + (W - 56) / 2}" y="150" text-anchor="middle">${esc(name)}</text></svg><figcaption>${foot}</figcaption></figure>`;
}
function sized(k, cls, foot) {
  const [name, , hit, n, lo, hi, , [mid, at, share, s90, top]] = k, L = 46, W = 310, T = 8, H = 120;
  const A = axis([...mid, ...at, s90 || 0, top || 0], 0), X = v => R(L + W * A.x(v)), Y = p => R(T + H * (1 - p));
  let g = yaxis([0, .5, .9], L, W, Y, T + H / 2, 'right [%]') + xaxis(A, X, L, W, T + H, esc(name));
  g += `<path class="ik" d="M${at.map((v, i) => `${X(v)} ${Y(share[i] / 1000)}`).join('L')}"/>`;
  [[s90, 'on'], [top, 'lim']].forEach(([v, c]) => { if (v !== null) g += `<path class="${c}" d="M${X(v)} ${T}v${H}"/>`; });
  mid.forEach((v, i) => {
    if (!n[i] || v === null) return;
    const x = X(v), y = Y(hit[i] / n[i]);
    if (lo[i] !== null) g += `<path class="e${cls}" d="M${x} ${Y(lo[i] / 100)}V${Y(hi[i] / 100)}"/>`;
    g += `<circle class="d${cls}" cx="${x}" cy="${y}" r="3.5"><title>${hit[i]} of ${n[i]}</title></circle><text class="ts z9" ${y > 106 ? `x="${x - 6}" y="${y - 6}" text-anchor="end"` : `x="${x + 6}" y="${y + 14}"`}>${hit[i]}/${n[i]}</text>`;
  });
  return `<figure><svg viewBox="0 0 366 162" role="img" aria-label="${esc('right [%] by ' + name)}">${g}</svg><figcaption>${foot}</figcaption></figure>`;
}
function quality(c) {
  const heads = ['median [s]', '95 % [s]', 'max [s]', 'max / limit', 'isolated', 'most changes', 'bias of estimate', 'rms', 'healthy margin', 'bound [%]'];
  const shown = heads.map((h, i) => [h, c.x[i]]).filter(([, v]) => v);
  return shown.length ? `<div class="scroll" tabindex="0" role="region" aria-label="Times and quality"><table data-copy="times and quality"><thead><tr>${shown.map(([h]) => `<th scope="col">${h}</th>`).join('')}</tr></thead><tbody><tr>${shown.map(([, v]) => `<td>${v}</td>`).join('')}</tr></tbody></table></div>` : '';
}
function declared(c) {
  const truth = [...new Set(c.q.map(q => q[0]))], one = truth.length === 1;
  const lines = c.q.map(([t, a, n]) => {
    const good = t === a, none = a === '';
    return `<tr>${one ? '' : `<td>${esc(t)}</td>`}<th scope="row">${none ? 'none' : esc(a)}</th><td class="${good ? '' : 'bad'}">${thin(n)}</td><td><svg width="120" height="11" viewBox="0 0 120 11" aria-hidden="true"><rect class="${good ? 'o0' : none ? 'o3' : 'o4'}" width="${R(120 * n / c.n)}" height="11"/></svg></td></tr>`;
  }).join('');
  return `<figure><h3>Declared at the end${one ? ` (true: ${esc(truth[0])})` : ''}</h3><table data-copy="declared"><thead><tr>${one ? '' : '<th scope="col">true</th>'}<th scope="col">declared</th><th scope="col">flights</th><td></td></tr></thead><tbody>${lines}</tbody></table></figure>`;
}
function beside(c) {
  if (!c.b) return '';
  const [diff, lo, hi, p, a, b, n] = c.b;
  const best = esc(document.getElementById('detail').dataset.best || '');
  return `<p>Beside ${best} on the same ${thin(n)} flights: ${diff > 0 ? '+' : ''}${diff} % right${lo === null ? '' : ` (${lo} to ${hi})`}; right here alone ${thin(b)}, there alone ${thin(a)}; ${lo === null ? 'one run is no test' : `McNemar by run, Holm over scenarios: p = ${p === null ? '–' : p}`}.${lo === null || p !== null && p < .05 ? '' : ' Chance may explain it.'}</p>`;
}
function detail() {
  const {s, d} = state, c = D.c[s] && D.c[s][d], box = document.getElementById('detail');
  $('button[data-c]').forEach(b => b.setAttribute('aria-pressed', b.dataset.c === `${s},${d}`));
  if (!c) { box.innerHTML = ''; return; }
  const S = D.s[s], names = S.h ? ['quiet', '', '', '', '', 'with a false alarm'] : NAMES;
  const said = c.o.map((k, i) => k ? `<b>${thin(k)}</b> ${names[i]}` : '').filter(Boolean).join(', ');
  let h = `<h2>${esc(S.n)} – ${esc(D.d[d])}</h2><p>${thin(c.n)} flown: ${said || 'nothing'}.${c.r.length ? ` Right: ${c.r[0]} % of the decided${c.r[1] ? ` (95 %: ${c.r[1]})` : ', one run has no interval'}${S.m ? `, pools ${esc(S.m)}, by run` : ''}.` : ''}${c.z ? ` Besides ${c.z[0]} infeasible, ${c.z[1]} failed; ${c.z[2]} departed.` : ''}</p>` + beside(c);
  h += '<div class="grid wide">' + (S.h ? '' : curve(s, d)) + (c.q ? declared(c) : '') + '</div>' + quality(c);
  if (c.a) h += '<h3>What goes with failure, strongest first</h3><div class="grid">' + c.a.map(([p, v, k, n, lo, hi]) => parts(S.p[p][0], S.p[p][1], k, n, lo, hi, 0, 'failed [%]', `association V = ${v} (0: chance, 1: decides)`)).join('') + '</div>';
  if (c.k) {
    const foot = `${esc(c.k[6])} ${c.k[7] ? 'Line: the fitted curve; dotted: found in 90 %; dashed: its upper end at 95 % confidence. ' : ''}Size as flown, in its own unit, not normalised. Every size: <code>fddbench pod ${esc(D.f)}</code>`;
    h += '<h3>Found in time against the size of the fault</h3><div class="grid">' + (c.k[7] ? sized(c.k, 2, foot) : parts(...c.k.slice(0, 6), 2, 'right [%]', foot)) + '</div>';
  }
  if (c.w) h += `<h3>${c.o.slice(1).some((k, i) => k && i !== 1) ? 'Worst flights' : 'Slowest flight'}</h3><p>${c.w.map(w => `<code>fddbench replay ${esc(D.f)} ${esc(S.n)}/${w} --plot flight.html</code>`).join('<br>')}</p>`;
  box.innerHTML = h;
  tools(box);
}
function keep() {
  const q = new URLSearchParams();
  if (D.s[state.s]) { q.set('scenario', D.s[state.s].n); q.set('detector', D.d[state.d]); }
  state.off.forEach(j => q.append('off', D.d[j]));
  if (state.bad) q.set('failures', '1');
  if (state.sort) q.set('worst', '1');
  history.replaceState(null, '', '#' + q);
}
function apply() {
  $('[data-d]', matrix).forEach(e => e.classList.toggle('off', state.off.has(+e.dataset.d)));
  const failed = (s, j) => { const c = D.c[s][j]; return c && !state.off.has(j) && c.o.some((k, i) => k && i !== 0 && i !== 2); };
  const rows = $('tr[data-s]', matrix);
  rows.forEach(t => t.classList.toggle('off', state.bad && !D.d.some((_, j) => failed(+t.dataset.s, j))));
  rows.sort((a, b) => state.sort ? b.dataset.w - a.dataset.w || a.dataset.s - b.dataset.s : a.dataset.s - b.dataset.s).forEach(t => t.parentNode.append(t));
  $('[data-t]', form).forEach(b => { b.checked = !state.off.has(+b.dataset.t); });
  const [bad, sort] = ['bad', 'sort'].map(id => document.getElementById(id));
  bad.checked = state.bad; sort.checked = state.sort;
}
function worst() {
  let found = [-1, -1], most = -1;
  D.c.forEach((line, s) => line.forEach((c, j) => {
    if (!c || state.off.has(j) || !c.n) return;
    const bad = (D.s[s].h ? 0 : .001) + (2 * c.o[4] + c.o[3] + c.o[1] + c.o[5]) / c.n;
    if (bad > most) { most = bad; found = [s, j]; }
  }));
  return found;
}
function read() {
  const q = new URLSearchParams(location.hash.slice(1));
  state.off = new Set(q.getAll('off').map(n => D.d.indexOf(n)).filter(j => j >= 0));
  state.bad = q.has('failures'); state.sort = q.has('worst');
  [state.s, state.d] = [D.s.findIndex(x => x.n === q.get('scenario')), D.d.indexOf(q.get('detector'))];
  if (!(D.c[state.s] && D.c[state.s][state.d])) [state.s, state.d] = worst();
  apply(); detail();
}
function copied(table, how) {
  const rows = [...table.rows].filter(r => !r.classList.contains('off')).map(r => [...r.cells].filter(c => !c.classList.contains('off')).map(c => {
    const small = $('small', c).map(x => x.textContent), text = [...c.childNodes].filter(x => x.nodeName !== 'SMALL').map(x => x.textContent).join('').trim();
    return (text + (small.length ? ` (${small.join('; ')})` : '')).replace(/\u202f/g, '');
  }));
  if (how === 'CSV') return rows.map(r => r.map(v => /[",\n]/.test(v) ? `"${v.replace(/"/g, '""')}"` : v).join(',')).join('\n') + '\n';
  const tex = v => v.replace(/[\\{}_%&#$^~]/g, c => ({'\\': '\\textbackslash{}', '^': '\\^{}', '~': '\\~{}'}[c] || '\\' + c)).replace(/</g, '$<$').replace(/>/g, '$>$').replace(/≤/g, '$\\le$').replace(/≥/g, '$\\ge$').replace(/ … /g, '--').replace(/–/g, '--').replace(/−/g, '$-$');
  return `\\begin{tabular}{${'l'.repeat(Math.max(...rows.map(r => r.length)))}}\n\\toprule\n${tex2(rows[0], tex)}\\midrule\n${rows.slice(1).map(r => tex2(r, tex)).join('')}\\bottomrule\n\\end{tabular}\n`;
}
const tex2 = (r, tex) => r.map(tex).join(' & ') + ' \\\\\n';
async function copy(text, button) {
  try { await navigator.clipboard.writeText(text); } catch (_) {
    const area = document.createElement('textarea'); area.value = text; document.body.append(area); area.select();
    document.execCommand('copy'); area.remove();
  }
  const before = button.textContent; button.textContent = 'copied'; setTimeout(() => { button.textContent = before; }, 1200);
}
function tools(root) {
  $('table[data-copy], table.matrix', root).forEach(t => {
    const bar = document.createElement('p'); bar.className = 'tools';
    ['CSV', 'LaTeX'].forEach(how => {
      const b = document.createElement('button'); b.type = 'button'; b.textContent = `copy as ${how}`;
      b.setAttribute('aria-label', `copy ${t.dataset.copy || 'outcome matrix'} as ${how}`);
      b.addEventListener('click', () => copy(copied(t, how), b)); bar.append(b);
    });
    (t.closest('.scroll') || t).after(bar);
  });
}
tools(document.querySelector('main'));
if (matrix) {
  form.innerHTML = D.d.map((n, j) => `<label><input type="checkbox" checked data-t="${j}"> ${esc(n)}</label>`).join('') + '<label><input type="checkbox" id="bad"> only scenarios with failures</label><label><input type="checkbox" id="sort"> worst first</label>';
  form.addEventListener('submit', e => e.preventDefault());
  form.addEventListener('change', e => {
    const j = e.target.dataset.t;
    if (j !== undefined) e.target.checked ? state.off.delete(+j) : state.off.add(+j);
    state.bad = document.getElementById('bad').checked; state.sort = document.getElementById('sort').checked;
    apply(); detail(); keep();
  });
  matrix.addEventListener('click', e => { const b = e.target.closest('button[data-c]'); if (b) { [state.s, state.d] = b.dataset.c.split(',').map(Number); detail(); keep(); } });
  matrix.addEventListener('keydown', e => {
    const b = e.target.closest('button[data-c]'); if (!b || !/^Arrow/.test(e.key)) return;
    const shown = r => !r.classList.contains('off') && r.querySelector('button');
    const row = b.closest('tr'), rows = $('tr[data-s]', matrix).filter(shown), cols = $('td:not(.off) button', row);
    const at = cols.indexOf(b), line = rows[rows.indexOf(row) + (e.key === 'ArrowDown') - (e.key === 'ArrowUp')] || row;
    const next = line === row ? cols[at + (e.key === 'ArrowRight') - (e.key === 'ArrowLeft')] : line.querySelector(`button[data-c="${line.dataset.s},${b.dataset.c.split(',')[1]}"]`);
    e.preventDefault(); if (next) { next.focus(); next.click(); }
  });
  addEventListener('hashchange', read);
  read();
}
let opened = [];
addEventListener('beforeprint', () => { opened = $('details:not([open])'); opened.forEach(e => { e.open = true; }); });
addEventListener('afterprint', () => { opened.forEach(e => { e.open = false; }); });
})();
