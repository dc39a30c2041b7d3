"""Jobs of the laboratory in pieces: the atlas, the conformance folder, tables and nets."""

import pathlib

from fault_cases import needs_embree
from harness import case, check
from pieces_cases import files_of, have_scripts, one_and_pieces

ROOT = pathlib.Path(__file__).resolve().parents[3]


@case("pieces.of_an_atlas_make_its_bytes", budget=8)
def atlas(bench):
    needs_embree(bench)
    one_and_pieces(bench, ("atlas", "albedo_by_a_fit", "bent_normal_bends_too_far", "area_lights_left_out", "--quick", "-q"), ("atlas",))


@case("pieces.of_a_conformance_folder_make_its_bytes", tier="nightly", budget=30)
def conform(bench):
    needs_embree(bench)
    words = ("conform", "--samples", "64", "-q", "--write")
    bench.run(*words, "one", timeout=200).expect(0)
    bench.run(*words, "two", "--shard", "2/2", "--work", "w", timeout=200).expect(0)
    missing = bench.run("merge", "w").expect(5)
    check(len(missing.out.splitlines()) == 16 and not (bench.folder / "two").exists(), missing.describe())
    bench.run(*words, "two", "--take", "--work", "w", timeout=200).expect(0)
    bench.run("merge", "w").expect(0)
    check(files_of(bench.folder / "one") == files_of(bench.folder / "two"), "other files")


@case("pieces.of_a_table_make_its_bytes", budget=10)
def table(bench):
    one_and_pieces(bench, ("bake", "ltc", "--resolution", "4", "--steps", "2", "-q"), ("a.ltc",), machine=("--threads", "1"))
    bench.run("bake", "ltc", "--table", "two/a.ltc", "--pieces").expect(2).expect_one_line("--table")


@case("pieces.of_measured_nets_make_their_figures", tier="nightly")
def nets(bench):
    """In check, `pieces.of_a_table_make_its_bytes` and `pieces.of_an_atlas_make_its_bytes` hold the laboratory's pieces."""
    net = str(ROOT / "shading/bake/mipnet/ggx_aniso.mipnet")
    one_and_pieces(bench, ("train", "mip", "--evaluate", net, "--validation", "-q"), ("figures.json",), option="--json", machine=("--threads", "1"))


@case("pieces.wrong_words_of_the_laboratory_are_named", "input")
def wrong(bench):
    for engine, job, needle in (("mpi", ("chart", "--mip", "-o", "r"), "no pieces"),
                                ("slurm", ("bake", "ltc", "--table", "t.ltc", "--preview", "p"), "no pieces"),
                                ("slurm", ("train", "mip", "-o", "n", "--checkpoint", "c"), "--checkpoint")):
        bench.run("submit", "--for", engine, "--", *job).expect(2).expect_one_line(needle)


@case("pieces.scripts_for_jobs_of_the_laboratory_merge")
def scripts(bench):
    have_scripts(bench, ("bake", "ltc", "-o", "t.ltc", "--report", "quality"), ("bake", "ltc", "-o", "t.ltc"),
                 ("train", "mip", "--evaluate", "nets", "-o", "r"), ("train", "mip", "--seeds", "8", "-o", "n"))
