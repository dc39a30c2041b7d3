// Regenerates mikktspace_golden.txt in this folder from the npm package mikktspace 1.1.1 (WebAssembly, for node):
//   npm install --prefix SOME_FOLDER mikktspace@1.1.1
//   NODE_PATH=SOME_FOLDER/node_modules node make_mikktspace_golden.mjs
// Lines: "case NAME CORNERS", then one corner a line: position, normal, uv, expected tangent with sign (12 numbers).
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const { generateTangents } = createRequire(import.meta.url)('mikktspace');

const unit = (v) => v.map((x) => x / Math.hypot(...v));
const corner = (p, n, t) => [...p, ...n, ...t];
const quad = (a, b, c, d) => [a, b, c, a, c, d];

let seed = 12345;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 4294967296;

// Points of a grid, as triangles; point(i, j) gives a corner.
function grid(columns, rows, point) {
    const out = [];
    for (let j = 0; j < rows; ++j)
        for (let i = 0; i < columns; ++i)
            out.push(...quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)));
    return out;
}

const up = [0, 0, 1];
const cases = {
    plain: grid(2, 2, (i, j) => corner([i, j, 0], up, [i / 2, j / 2])),
    v_down: grid(2, 2, (i, j) => corner([i, j, 0], up, [i / 2, 1 - j / 2])),
    skewed: grid(2, 2, (i, j) => corner([i + 0.3 * j, j * 1.5, 0.2 * i * j], unit([-0.1, 0.2, 1]), [i + 0.7 * j, j - 0.2 * i])),
    mirrored: grid(4, 2, (i, j) => corner([i - 2, j, 0], up, [Math.abs(i - 2) / 2, j / 2])),
};

cases.cube = [];
for (let axis = 0; axis < 3; ++axis)
    for (const side of [-1, 1]) {
        const point = (a, b) => {
            const p = [0, 0, 0];
            p[axis] = side;
            p[(axis + 1) % 3] = a * side;
            p[(axis + 2) % 3] = b;
            return p;
        };
        const flat = [0, 0, 0];
        flat[axis] = side;
        const at = (a, b, n) => corner(point(a, b), n, [(a + 1) / 2, (b + 1) / 2]);
        const smooth = axis === 2; // the last two faces have rounded normals
        cases.cube.push(...quad(...[[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => at(a, b, smooth ? unit(point(a, b)) : flat))));
    }

// Has a seam where u jumps, and pole quads with one collapsed triangle.
cases.sphere = grid(8, 4, (i, j) => {
    const a = (2 * Math.PI * (i % 8)) / 8, b = Math.PI * (j / 4 - 0.5), c = j % 4 ? Math.cos(b) : 0;
    const p = [c * Math.cos(a), c * Math.sin(a), j % 4 ? Math.sin(b) : Math.sign(b)];
    return corner(p, p, [i / 8, j / 4]);
});

// Some triangles without area in texture space: between good ones, at the rim, and one without neighbours.
cases.empty_uv = grid(4, 2, (i, j) => corner([i, j, 0.1 * i * i], unit([-0.2 * i, 0, 1]), [i < 2 ? i / 4 : i === 2 ? 0.25 : (i - 1) / 4, j / 2]));
cases.lonely = [[0, 0], [1, 0], [0, 1]].map(([x, y]) => corner([x, y, 0], up, [0.5, 0.5]));
cases.line_uv = [...quad(...[[0, 0], [1, 0], [1, 1], [0, 1]].map(([x, y]) => corner([x, y, 0], up, [x * 0.5, x * 0.5]))),
    ...[[1, 0], [2, 0], [1, 1]].map(([x, y]) => corner([x, y, 0], up, [x * 0.5, x === 1 ? 0.5 : 0.1 + y]))];
// Triangles without area in space, which borrow from neighbours that share a vertex.
cases.collapsed = [
    ...[[0, 0], [1, 0], [0, 1]].map(([x, y]) => corner([x, y, 0], up, [x, y])),
    ...[[1, 0], [0, 1], [0, 1]].map(([x, y]) => corner([x, y, 0], up, [x, y])),
    ...[[1, 0], [1, 0], [0, 0]].map(([x, y]) => corner([x, y, 0], up, [x, y])),
];
// Corners too close for floats to tell their differences to a third corner apart: no gradient, though not collapsed.
cases.sliver = [[[0.130526, -0.991445, 0], [0.129409, -0.991445, 0.017037], [1e-16, -1, 0]],
    [[0.129409, -0.991445, 0.017037], [1.1e-16, -1, 1.6e-17], [1e-16, -1, 0]]]
    .flat().map((p) => corner(p, unit(p), [p[2] === 0 ? 0 : 0.02, p[0] < 0.1 ? 0 : 0.04]));
// Two triangles that share one vertex, and turn differently in texture space.
cases.bow_tie = [
    ...[[0, 0], [1, 0], [1, 1]].map(([x, y]) => corner([x, y, 0], up, [x, y])),
    ...[[0, 0], [-1, 0], [-1, -1]].map(([x, y]) => corner([x, y, 0], up, [-y, x])),
];
// Three triangles on an edge.
cases.fin = [
    ...[[0, 0, 0], [0, 1, 0], [-1, 0, 0]].map((p) => corner(p, up, [p[0], p[1]])),
    ...[[0, 1, 0], [0, 0, 0], [1, 0.5, 0]].map((p) => corner(p, up, [p[0] + 0.5 * p[1] * p[0], p[1]])),
    ...[[0, 1, 0], [0, 0, 0], [0.5, 0.5, 1]].map((p) => corner(p, up, [p[0] + p[2], p[1] - p[2]])),
];
cases.rough = (() => {
    const points = Array.from({ length: 49 }, (_, k) =>
        corner([(k % 7) + 0.4 * random(), Math.floor(k / 7) + 0.4 * random(), random()], unit([random() - 0.5, random() - 0.5, 1]),
            [(k % 7) / 7 + 0.2 * random(), Math.floor(k / 7) / 7 + 0.2 * random()]));
    return grid(6, 6, (i, j) => points[j * 7 + i]);
})();

const lines = ['# Tangents by the npm package mikktspace 1.1.1; made by make_mikktspace_golden.mjs'];
for (const [name, corners] of Object.entries(cases)) {
    const column = (from, to) => new Float32Array(corners.flatMap((c) => c.slice(from, to)));
    const p = column(0, 3), n = column(3, 6), t = column(6, 8), out = generateTangents(p, n, t);
    lines.push(`case ${name} ${corners.length}`);
    const text = (a, size, i) => Array.from(a.slice(size * i, size * i + size), (x) => String(Number(x.toPrecision(9))));
    for (let i = 0; i < corners.length; ++i)
        lines.push([...text(p, 3, i), ...text(n, 3, i), ...text(t, 2, i), ...text(out, 4, i)].join(' '));
}
writeFileSync(join(dirname(fileURLToPath(import.meta.url)), 'mikktspace_golden.txt'), lines.join('\n') + '\n');
