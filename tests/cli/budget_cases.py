"""burnish render --budget: technique and samples of each material, chosen for a largest error."""

import json
import re

from harness import case, check

SMALL = ("--env-size", "64", "--env-samples", "64")
POT = ("render", "builtin:teapot", "--size", "320x180", "--msaa", "2", *SMALL)


def stats_of(bench, name):
    return json.loads((bench.folder / name).read_text())


def settings_of(bench, name):
    return [(m["technique"], m["samples"]) for m in stats_of(bench, name)["materials"]]


def flip(bench, reference, test):
    done = bench.run("compare", reference, test, "--metric", "flip-hdr")
    return float(re.search(r"flip-hdr +mean ([\d.]+)", done.out)[1])


@case("budget.holds_and_saves", budget=4)
def holds(bench):
    """The error stays below the budget, at the cost of fewer instructions; materials get settings of their own."""
    bench.run(*POT, "--technique", "mc", "--samples", "2048", "-o", "reference.pfm").expect(0)
    before = 0.0
    for budget in (0.2, 0.08):
        name = f"b{budget}"
        done = bench.run(*POT, "--budget", budget, "-o", f"{name}.pfm", "--stats", f"{name}.json", "--plan-out", "plan.json").expect(0)
        plan, error = stats_of(bench, f"{name}.json")["plan"], flip(bench, "reference.pfm", f"{name}.pfm")
        check(error <= budget, f"the error is {error}, the budget {budget}")
        check(error <= 1.3 * plan["predicted_flip"], f"the error is {error}, predicted {plan['predicted_flip']}")
        check(before < plan["instructions"] < 0.6 * plan["usual_instructions"], plan)
        check(f"mean HDR-FLIP {budget}: predicted" in done.err and "next better: " in done.err, done.err)
        before = plan["instructions"]
    check(len(set(settings_of(bench, "plan.json"))) > 1, "all materials have one setting")


@case("budget.of_the_percentile_holds_the_tail", budget=20)
def percentile(bench):
    """At most one pixel in a hundred errs more than the budget, beside a mean that one holds too. The reference needs many samples."""
    bench.run(*POT, "--technique", "mc", "--samples", "2048", "-o", "reference.pfm").expect(0)
    means = {}
    for words in (("--budget-p99", "0.3"), ("--budget-p99", "0.3", "--budget", "0.02"), ("--budget", "0.02")):
        done = bench.run(*POT, *words, "-o", "test.pfm", "--stats", "a.json").expect(0)
        plan = stats_of(bench, "a.json")["plan"]
        mean, p99 = map(float, re.search(r"flip-hdr +mean ([\d.]+), p99 ([\d.]+)", bench.run("compare", "reference.pfm", "test.pfm").out).groups())
        means[words] = plan["instructions"]
        if "--budget-p99" in words:
            check(p99 <= 0.3 and plan["budget_p99"] == 0.3, f"{words}: p99 {p99}")
            check("99th percentile of HDR-FLIP 0.3: predicted" in done.err and 0.2 < p99 / plan["predicted_p99"] < 1.3, f"{p99} {plan} {done.err}")
        check("--budget" not in words or mean <= 0.02, f"{words}: mean {mean}")
    alone, both, mean = means.values()
    check(both >= max(alone, mean), f"{means}")
    for words, needle in ((("--budget-p99", "0"), "no technique is exact"), (("--budget-p99", "1e-6"), "--budget-p99: no setting reaches"),
                          (("--budget-p99", "1e-6", "--budget", "0.1"), "--budget-p99: no setting reaches"), (("--budget-p99", "nan"), "--budget-p99"),
                          (("--budget-p99", "0.3", "--plan", "p.json"), "--plan"), (("--budget-p99", "0.3", "--risks", "-"), "--risks")):
        bench.run(*POT, *words).expect(2).expect_one_line(needle)


LIT = ("render", "builtin:lights", "--size", "320x180", "--msaa", "1", *SMALL)


@case("budget.holds_under_area_lights", budget=10)
def area_lit(bench):
    """Cosines for area lights err by more than a small budget, so its picture has points on the lights. The reference's points cost most of the time."""
    bench.run(*LIT, "--technique", "mc", "--samples", "1024", "--area-lights", "mc", "--light-samples", "256", "-o", "reference.pfm").expect(0)
    ways = []
    for budget in (0.1, 0.03):
        done = bench.run(*LIT, "--budget", budget, "-o", "a.pfm", "--stats", "a.json", "--plan-out", "plan.json").expect(0)
        plan, stats, error = stats_of(bench, "plan.json"), stats_of(bench, "a.json"), flip(bench, "reference.pfm", "a.pfm")
        check(error <= budget and error <= 1.3 * plan["predicted_flip"], f"the error is {error}, predicted {plan['predicted_flip']}, the budget {budget}")
        check(re.search(r"budget +area lights: .*, error [\d.]+ over the picture; next ", done.err), done.err)
        ways.append(plan["area_lights"]["method"])
        check((stats["area_lights"], stats["light_samples"]) == (ways[-1], plan["area_lights"]["samples"]), f"{budget}: the figures name {stats['area_lights']}")
        # The plan file and the step of an animation take the same method
        bench.run(*LIT, "--plan", "plan.json", "--stats", "b.json").expect(0)
        check(stats["pixel_hash"] == stats_of(bench, "b.json")["pixel_hash"], f"{budget}: another picture by the plan file")
        bench.run(*LIT, "--budget", budget, "--animate", "exposure=0:1", "--steps", "2", "--stats", "b.json").expect(0)
        check(all(step["pixel_hash"] == stats["pixel_hash"] for step in stats_of(bench, "b.json")["steps"]), f"{budget}: another picture in a row")
    check(ways[0] != "mc" and ways[1] == "mc", f"{ways}")
    # A given method stays
    for words in (("--area-lights", "ltc"), ("--light-samples", "16")):
        bench.run(*LIT, "--budget", "0.1", *words, "--plan-out", "given.json").expect(0)
        check(stats_of(bench, "given.json")["area_lights"]["method"] == "ltc", f"{words}")
    bench.run(*LIT, "--budget", "0.02", "--area-lights", "ltc").expect(2).expect_one_line("no setting reaches 0.02")
    bench.run(*LIT, "--budget", "0.1", "--area-lights", "off", "--plan-out", "off.json").expect(0)
    check("area_lights" not in stats_of(bench, "off.json"), "lights without light have a method")


@case("budget.leaves_bodies_of_glass_to_techniques_that_follow_light_through_them", budget=6)
def glass(bench):
    """By mc a body is as dark as one interface over a black inside."""
    lit = ("render", "builtin:glass", "--size", "320x180", "--msaa", "1", *SMALL)

    def technique_of(*words):
        bench.run(*lit, *words, "--plan-out", "plan.json").expect(0)
        return {m["name"]: m["technique"] for m in stats_of(bench, "plan.json")["materials"] if m["share"] > 0}

    bodies = {"clear", "frosted", "rough", "brushed amber"}
    planned = technique_of("--budget", "0.04")
    check(bodies <= set(planned) and "mc" in planned.values(), f"{planned}")
    check(all(planned[name] != "mc" for name in bodies), f"{planned}")
    check(technique_of("--budget", "0.04", "--glass", "interface")["brushed amber"] == "mc", "one interface is not left to mc")
    check(set(technique_of("--budget", "0.2", "--technique", "mc").values()) == {"mc"}, "a given technique is not kept")


@case("budget.plans_are_drawn_again_with_the_same_pixels", budget=3)
def replayed(bench):
    bench.run(*POT, "--budget", "0.06", "--plan-out", "plan.json", "--stats", "a.json").expect(0)
    for i, words in enumerate((("--threads", "1"), ("--isa", "scalar"), ("--tile-size", "32"))):
        bench.run(*POT, "--plan", "plan.json", *words, "--stats", "b.json").expect(0)
        check(stats_of(bench, "a.json")["pixel_hash"] == stats_of(bench, "b.json")["pixel_hash"], words)
        bench.run(*POT, "--budget", "0.06", *words, "--plan-out", f"p{i}.json").expect(0)
        check((bench.folder / f"p{i}.json").read_text() == (bench.folder / "plan.json").read_text(), f"another plan with {words}")
    done = bench.run(*POT, "--budget", "0.06", "--plan-out", "-", "-q").expect(0)
    check(done.out == (bench.folder / "plan.json").read_text(), "standard output has another plan")


@case("budget.plans_are_drawn_on_a_device_with_the_same_pixels", tier="nightly")
def on_device(bench):
    """Materials with different techniques share one frame of the device."""
    small = ("render", "builtin:teapot", "--size", "200x160", "--msaa", "1", *SMALL)
    bench.run(*small, "--budget", "0.06", "--plan-out", "plan.json", "--stats", "a.json").expect(0)
    check(len(set(settings_of(bench, "plan.json"))) > 1, "all materials have one setting")
    for words in (("--plan", "plan.json"), ("--budget", "0.06")):
        bench.run(*small, *words, "--backend", "vulkan", "--device", "lavapipe", "--stats", "b.json", timeout=300.0).expect(0)
        check(stats_of(bench, "a.json")["pixel_hash"] == stats_of(bench, "b.json")["pixel_hash"], "the device draws other pixels")


@case("budget.plan_of_something_else_is_refused_by_name", budget=3)
def other(bench):
    bench.run(*POT, "--budget", "0.1", "--plan-out", "plan.json").expect(0)
    for words, place in ((("--size", "320x200"), "/size"), (("--env", "builtin:sky"), "/environment"), (("--zoom", "2"), "/view"),
                         (("--roughness", "0.3"), "/content"), (("--env-exposure", "1"), "/content"), (("--msaa", "4"), "/content"),
                         (("--axis-k", "2"), "/content")):
        bench.run(*POT, "--plan", "plan.json", *words).expect(4).expect_one_line("plan.json", place)
    bench.run("render", "builtin:spheres", *POT[2:], "--plan", "plan.json").expect(4).expect_one_line("plan.json", "/scene")
    plan = stats_of(bench, "plan.json")
    for change, place in (({"technique": "none"}, "/materials"), ({"technique": "filtered_is"}, "/materials"), ({"samples": 0}, "/materials"),
                          ({"samples": "many"}, "/materials/0")):
        changed = {**plan, "materials": [{**plan["materials"][0], **change}, *plan["materials"][1:]]}
        (bench.folder / "changed.json").write_text(json.dumps(changed))
        bench.run(*POT, "--plan", "changed.json").expect(4).expect_one_line("changed.json", place)
    (bench.folder / "changed.json").write_text(json.dumps({**plan, "version": "0.0.1"}))
    bench.run(*POT, "--plan", "changed.json").expect(4).expect_one_line("changed.json", "/version")
    bench.run(*POT, "--plan", "absent.json").expect(4).expect_one_line("absent.json")


@case("budget.wrong_options_say_one_line_and_exit_2")
def wrong(bench):
    for words, needle in (
            (("--budget", "0"), "no technique is exact"), (("--budget", "-1"), "--budget"), (("--budget", "nan"), "--budget"),
            (("--budget", "2"), "--budget"), (("--budget", "1e-9"), "no setting reaches"),
            (("--budget", "0.1", "--backend", "reference"), "reference"), (("--budget", "0.1", "--plan", "p.json"), "--plan"),
            (("--budget", "0.1", "--technique", "mc", "--samples", "64"), "nothing to choose"),
            (("--budget", "0.01", "--technique", "split_isotropic"), "no setting reaches"),
            (("--budget", "0.1", "--technique", "filtered_is"), "--budget"), (("--budget", "0.1", "--brdf", "ward", "--technique", "mc"), "--brdf"), (("--plan", "p.json", "--samples", "4"), "--samples"),
            (("--plan-out", "p.json"), "--plan-out"), (("--verify",), "--verify"), (("--budget", "0.1", "--risks", "-"), "--risks"),
            (("--budget", "0.1", "--verify", "--shadows", "on"), "--verify")):
        bench.run(*POT, *words).expect(2).expect_one_line(needle)
    # No input is overwritten, and no file is named twice
    (bench.folder / "own.json").write_text("{}")
    bench.run(*POT, "--plan", "own.json", "--stats", "own.json").expect(2).expect_one_line("own.json")
    bench.run(*POT, "--budget", "0.1", "--plan-out", "x.json", "--stats", "x.json").expect(2).expect_one_line("x.json")
    bench.run(*POT, "--budget", "0.1", "--plan-out", "none/x.json").expect(7).expect_one_line("none")


@case("budget.of_time_takes_the_least_error_within_it", budget=10)
def time(bench):
    done = bench.run(*POT, "--budget-ms", "100000", "--stats", "a.json").expect(0)
    plan = stats_of(bench, "a.json")["plan"]
    check(plan["predicted_ms"] < 100000 and plan["predicted_flip"] < 0.01 and "another hash" in done.err, done.err)
    for words in ((), ("--budget", "0.1")):
        done = bench.run(*POT, "--budget-ms", "0.001", *words).expect(1)
        check("cannot be met" in done.err and "of the picture: " in done.err, done.describe())
    # A budget of errors goes first
    bench.run(*POT, "--budget-ms", "100000", "--budget", "0.1", "--stats", "b.json").expect(0)
    check(stats_of(bench, "b.json")["plan"]["predicted_flip"] > plan["predicted_flip"], "the error does not go first")
    for words, needle in ((("--backend", "reference"), "--budget-ms"), (("--backend", "vulkan"), "--budget-ms"), (("--plan", "p.json"), "--plan")):
        bench.run(*POT, "--budget-ms", "10", *words).expect(2).expect_one_line(needle)


@case("budget.keeps_what_is_fixed")
def fixed(bench):
    done = bench.run(*POT, "--budget", "0.1", "--technique", "lobe_line", "--plan-out", "plan.json").expect(0)
    check({t for t, _ in settings_of(bench, "plan.json")} <= {"lobe_line", "auto"} and "samples of lobe_line alone" in done.err, done.err)
    bench.run(*POT, "--budget", "0.2", "--samples", "512", "--plan-out", "plan.json").expect(0)
    check({n for _, n in settings_of(bench, "plan.json")} <= {1, 512, 36}, settings_of(bench, "plan.json"))
    for samples in ("20", "65536"):
        bench.run(*POT, "--budget", "0.2", "--samples", samples).expect(2).expect_one_line("costs are not known")
    # The default, written out, fixes nothing; parameters have readers among the plan's techniques
    done = bench.run(*POT, "--budget", "0.1", "--technique", "auto", "--seed", "7").expect(0)
    check("alone" not in done.err and "no effect" not in done.err, done.err)


@case("budget.stands_aside_where_a_plan_costs_more_than_it_saves")
def aside(bench):
    empty = ("--eye", "0,5,0", "--target", "0,9,0.1", "--floor", "off", "--size", "320x180")
    for words in (("--size", "96x64"), empty):
        done = bench.run("render", "builtin:teapot", *SMALL, *words, "--budget", "0.05", "--stats", "a.json", "--plan-out", "none.json").expect(0)
        check("stands aside" in done.err and "no plan to write" in done.err and "plan" not in stats_of(bench, "a.json"), done.err)
        check(not (bench.folder / "none.json").exists(), "a plan was written")
        bench.run("render", "builtin:teapot", *SMALL, *words, "--stats", "b.json").expect(0)
        check(stats_of(bench, "a.json")["pixel_hash"] == stats_of(bench, "b.json")["pixel_hash"], "the picture changed")


@case("budget.verify_measures_the_picture", budget=5)
def verify(bench):
    done = bench.run("render", "builtin:plate", "--size", "200x160", "--msaa", "4", *SMALL, "--budget", "0.1", "--verify").expect(0)
    found = re.search(r"verified +mean HDR-FLIP ([\d.]+), p99 [\d.]+, against 1024 samples of the reference; predicted ([\d.]+)", done.out)
    check(found and 0 < float(found[1]) < 0.1, done.describe())


@case("budget.one_plan_draws_an_animation", budget=10)
def animated(bench):
    done = bench.run(*POT, "--budget", "0.06", "--turntable", "3", "--plan-out", "plan.json", "-o", "t_%d.pfm", "--stats", "t.json").expect(0)
    check(done.err.count("mean HDR-FLIP") == 1 and stats_of(bench, "t.json")["plan"]["budget"] == 0.06, done.err)
    bench.run(*POT, "--plan", "plan.json", "--turntable", "3").expect(2).expect_one_line("--plan")
