"""Simulates many workers on a job in pieces: time, efficiency and requests to the shared folder.

    burnish render lamp.glb --backend reference --samples 4096 --size 1920x1080 --pieces > pieces.txt
    python3 bench/lab/cluster.py pieces.txt --start 0.4 --merge 0.002 --bytes 24000 --memory 120 -o cluster.svg

pieces.txt: the list of --pieces, whose seconds are measured. --start: a worker's time until its first piece (s). --merge: time of the merge
for a piece (s). --bytes: of a piece. --memory: of a worker (MB). --requests: requests that the folder's server answers a second. Workers take pieces by lease, each from another
place of the list on, as apps/pieces does, or have shares of their own. Prints a line for each number of workers, for both ways.
"""
import argparse
import heapq
import random

# Requests: a look at the folder, for each hundred names; to make, name and remove a lease and a piece; a beat every two seconds.
NAMES_A_REQUEST, MAKE, BEAT, BEAT_SECONDS = 100, 6, 3, 2.0


def taken(seconds, workers, start, rate):
    """Workers take pieces. Returns the time of the last piece (s), and requests."""
    count, chance = len(seconds), random.Random(1)
    left, server, requests, last = list(range(count)), 0.0, 0, 0.0
    free = [(start, w) for w in range(workers)]
    heapq.heapify(free)
    while free:
        time, w = heapq.heappop(free)
        asked = 1 + 2 * count // NAMES_A_REQUEST
        if left:
            at = chance.randrange(len(left))
            left[at], left[-1] = left[-1], left[at]
            piece = seconds[left.pop()]
            asked += MAKE + int(piece / BEAT_SECONDS) * BEAT
            server = max(server, time) + asked / rate
            last = max(last, server + piece)
            heapq.heappush(free, (server + piece, w))
        requests += asked
    return last, requests


def dealt(seconds, workers, start, rate):
    """Workers have shares: every N-th piece. Returns the same."""
    asked = 4  # is it there, and to write and name it
    shares = [seconds[w::workers] for w in range(workers)]
    busy = max(start + sum(share) for share in shares)
    requests = asked * len(seconds) + workers
    return max(busy, start + requests / rate), requests


def plot(rows, total):
    """Returns an SVG: efficiency over the number of workers, on a logarithmic axis. rows: {way: rows}."""
    import math
    wide, high, left, top = 520, 300, 60, 20
    x = lambda w: left + (wide - left - 20) * math.log10(w) / math.log10(max(rows["take"][-1][0], 10))
    y = lambda e: top + (high - top - 50) * (1 - e)
    ticks = "".join(f'<text x="{x(w):.0f}" y="{high - 30}" text-anchor="middle">{w}</text>' for w, *_ in rows["take"])
    lines = "".join(f'<line x1="{left}" x2="{wide - 20}" y1="{y(e):.1f}" y2="{y(e):.1f}" stroke="#ddd"/><text x="{left - 8}" y="{y(e) + 4:.1f}" text-anchor="end">{e:.1f}</text>'
                    for e in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0))
    curves = ""
    for way, colour, at in (("take", "#0b62a4", 0), ("shard", "#c2410c", 1)):
        points = " ".join(f"{x(w):.1f},{y(e):.1f}" for w, _, e, _, _ in rows[way])
        curves += f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>' + "".join(
            f'<circle cx="{x(w):.1f}" cy="{y(e):.1f}" r="3.5" fill="{colour}"/>' for w, _, e, _, _ in rows[way])
        curves += f'<text x="{left + 12}" y="{y(0.2) + 16 * at:.1f}" fill="{colour}">--{way}</text>'
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{high}" font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>'
            f'{lines}{ticks}{curves}<text x="{left}" y="14">share of the workers\' time that makes pieces ({total:.0f} s of pieces)</text>'
            f'<text x="{wide / 2:.0f}" y="{high - 8}" text-anchor="middle">workers</text></svg>\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pieces")
    parser.add_argument("--start", type=float, default=0.5)
    parser.add_argument("--merge", type=float, default=0.002)
    parser.add_argument("--bytes", type=int, default=24000)
    parser.add_argument("--memory", type=float, default=0.0)
    parser.add_argument("--requests", type=float, default=5000.0)
    parser.add_argument("--workers", default="1,3,10,30,100,300,1000")
    parser.add_argument("-o", "--output")
    given = parser.parse_args()
    seconds = [float(line.split()[1]) for line in open(given.pieces) if line.strip()]
    total, merge, rows = sum(seconds), given.merge * len(seconds), {"take": [], "shard": []}
    print(f"{len(seconds)} pieces, {total:.0f} s, the longest {max(seconds):.1f} s, {given.bytes * len(seconds) / 1e6:.0f} MB; merge {merge:.1f} s")
    print("workers  way       pieces s  with merge s  efficiency  requests  a second  memory GB")
    for workers in map(int, given.workers.split(",")):
        for name, way in (("take", taken), ("shard", dealt)):
            last, requests = way(seconds, workers, given.start, given.requests)
            row = (workers, last, total / (workers * last), requests, requests / last)
            print(f"{workers:7d}  {name:6s} {last:11.1f} {last + merge:13.1f} {row[2]:11.3f} {requests:9d} {row[4]:9.0f} {workers * given.memory / 1e3:10.1f}")
            rows[name].append(row)
    if given.output:
        with open(given.output, "w", encoding="utf-8") as file:
            file.write(plot(rows, total))


if __name__ == "__main__":
    main()
