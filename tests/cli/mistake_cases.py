"""Typical mistakes: each is answered with one line that tells what helps. The case prints the table."""

from harness import case, check

# What is typed, the exit code, what the line must say.
MISTAKES = (
    ("rendr", 2, "did you mean 'render'?"),
    ("lamp.glb", 4, "lamp.glb: cannot be opened"),
    ("help rendre", 2, "did you mean 'render'?"),
    ("list technique", 2, "did you mean 'techniques'?"),
    ("render --techniqe major_axis", 2, "did you mean '--technique'?"),
    ("render --outptu a.png", 2, "did you mean '--output'?"),
    ("render --technique major-axis", 2, "did you mean 'major_axis'?"),
    ("render --technique weighted", 2, "did you mean 'major_axis_weighted'?"),
    ("render --tonemap pbr", 2, "did you mean 'pbr-neutral'?"),
    ("render builtin:teapto", 2, "did you mean 'builtin:teapot'?"),
    ("render --env builtin:studoi", 2, "did you mean 'builtin:studio'?"),
    ("render teapot", 4, "builtin:teapot"),
    ("render Spheres", 4, "builtin:spheres"),
    ("render --env studio", 4, "builtin:studio"),
    ("render --env https://example.org/workshop.hdr", 4, "download it first"),
    ("render https://example.org/lamp.glb", 4, "download it first"),
    ("render chair.fbx", 4, "scenes are .gltf, .glb or .obj files"),
    ("render chair.obj", 4, "chair.obj: cannot be opened: No such file or directory"),
    ("render teapot.png", 4, "-o teapot.png"),
    ("render workshop.hdr --env builtin:sky", 4, "--env workshop.hdr"),
    ("render --env lamp.glb", 4, "burnish render lamp.glb"),
    ("render lamp.glb -o a.png", 4, "lamp.glb: cannot be opened"),
    ("render --size 1280", 2, "1280x720"),
    ("render --size 1280*720", 2, "1280x720"),
    ("render --eye 1 2 3", 2, "--eye takes X,Y,Z, with commas"),
    ("render --fov 400", 2, "0.1 to 179"),
    ("render --roughness 40", 2, "0 to 1"),
    ("render --msaa 3", 2, "1, 2, 4, 8, 16"),
    ("render --samples 0", 2, "--samples"),
    ("render --device lavapipe", 2, "needs --backend vulkan"),
    ("render -o picture.bmp", 2, "png"),
    ("render -o", 2, "--output: 1 required FILE missing"),
    ("render -o no/such/folder/a.png", 7, "no/such/folder"),
    ("compare a.png", 2, "TEST is required"),
    ("compare a.png b.png", 4, "a.png: cannot be opened"),
    ("chart", 2, "--output is required"),
)


@case("usage.typical_mistakes_are_answered_with_what_helps")
def mistakes(bench):
    small = ("--size", "16x16", "--env-size", "16", "--env-samples", "1", "--no-cache")
    wrong = []
    for typed, code, needle in MISTAKES:
        words = typed.split()
        done = bench.run(*words, *(small if code == 7 else ()))
        line = done.err.strip()
        print(f"burnish {typed}\n    {done.code}  {line}")
        if done.code != code or needle not in line or (code != 7 and "\n" in line):
            wrong.append(f"burnish {typed}: wanted exit code {code} and {needle!r}, got {done.code} and {line!r}")
    check(not wrong, "\n".join(wrong))
    check(bench.left_behind() == [], f"files were left: {bench.left_behind()}")


@case("usage.what_is_far_from_every_name_gets_no_guess")
def no_guess(bench):
    for words in (("frobnicate",), ("render", "--bogus"), ("render", "--technique", "nothing"), ("render", "nowhere.glb"), ("render", "x")):
        done = bench.run(*words)
        check(done.code != 0 and "did you mean" not in done.err and "called builtin" not in done.err, done.describe())
