"""The Connection Machines, in seconds.

The constants say where they come from:

* D. E. Culler and others, LogP: Towards a Realistic Model of Parallel Computation, PPoPP 1993, of Active
  Messages on the CM-5 (T. von Eicken and others, ISCA 1992): a packet of 16 bytes and an address takes 2 us
  of either node, and a node gets rid of one in 4 us, as the fat tree has 5 MB/s for it (C. E. Leiserson and
  others, The Network Architecture of the Connection Machine CM-5, SPAA 1992).
* CMMD 3.1 on the CM-5: combining an integer over the control network takes 5 us. Its messages take 80 us, but
  they wait for the receiver's consent, which compiled C* programs do not need.
* Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo, Supercomputing '93, 112-121, Table 1: the times that
  "calibrated" refers to.
* G. E. Blelloch, Scans as Primitive Parallel Operations, IEEE Transactions on Computers 38, 1989: a scan of
  the CM takes about 550 bit cycles, a reference through the router about 600.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil

from .._ledger.entry import Entry
from .model import CALIBRATED, ESTIMATE, SOURCED, Constant, Model, used_processors
from .pram import local_scan

TABLE1 = "Teng et al. 1993, Table 1, random sets, 32 nodes; `dt3d experiment table1` fits it anew"


def _cm5(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    if entry.primitive == "map":
        return c["issue"] + entry.operations * entry.vp_ratio * c["element"]
    if entry.primitive == "scan":
        across = c["combine"] if used_processors(entry) > 1 else 0.0
        return c["issue"] + entry.operations * (local_scan(entry) * c["element"] + across)
    packets = entry.busiest * ceil(max(1, entry.bytes) / c["packet_bytes"])
    return c["issue"] + entry.vp_ratio * c["route"] + packets * c["packet"]


CM5 = Model(
    "CM5",
    "SPARC nodes without vector units, a fat tree, a control network that scans. A step is issued to all "
    "nodes, which loop over elements and operations; a get or a send handles each element, wherever it "
    "leads, and the busiest node's packets come on top",
    _cm5,
    {
        "issue": Constant(5.09e-4, "s a step", CALIBRATED, TABLE1),
        "element": Constant(
            5e-7, "s an operation and element", ESTIMATE, "16 cycles at 32 MHz, of loads and a store, too"
        ),
        "route": Constant(2.76e-5, "s an element of a get or send", CALIBRATED, TABLE1),
        "packet": Constant(4e-6, "s a packet", SOURCED, "Culler et al. 1993: 2 us at either end"),
        "packet_bytes": Constant(16, "bytes a packet", SOURCED, "Culler et al. 1993, without the address"),
        "combine": Constant(5e-6, "s a scan", SOURCED, "CMMD 3.1: an integer over the control network"),
    },
)


def _cm2(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    compute = entry.operations * entry.vp_ratio * c["element"]
    words = max(1.0, entry.bytes / 4)
    if entry.primitive == "map":
        return compute
    if entry.primitive == "scan":
        return compute + entry.vp_ratio * words * c["scan"] / c["clock"]
    routed = max(entry.vp_ratio, entry.busiest) if entry.messages else 0
    return compute + routed * words * c["reference"] / c["clock"]


CM2 = Model(
    "CM2",
    "bit-serial processors, 32 to a floating-point unit, a hypercube router; 32-bit words. A step takes as "
    "many cycles for each virtual processor as the operation has",
    _cm2,
    {
        "clock": Constant(7e6, "cycles a second", ESTIMATE, "28 Gflop/s peak, 2,048 units, 2 flops a cycle"),
        "element": Constant(
            3.1e-5, "s an operation and element", ESTIMATE, "7.5 % of that peak, of 65,536"
        ),
        "scan": Constant(550, "cycles a word", SOURCED, "Blelloch 1989"),
        "reference": Constant(600, "cycles a word", SOURCED, "Blelloch 1989"),
    },
)  # fmt: skip
