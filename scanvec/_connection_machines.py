"""The Connection Machines, in seconds.

Every elementary operation is an instruction that goes out to all processors, each of which loops over its
virtual processors. The constants say where they come from:

* D. Culler and others, LogP: Towards a Realistic Model of Parallel Computation, PPoPP 1993: a CM-5 packet of
  20 bytes, 16 of them data, costs its sender and its receiver 2 us each; and 4 us is what 20 bytes take at
  the 5 MB/s that the fat tree has for each node beyond groups of 16 (C. E. Leiserson and others, The Network
  Architecture of the Connection Machine CM-5, SPAA 1992; 20 MB/s within 4 nodes, 10 within 16).
* CMMD 3.1 on the CM-5: a blocking message takes 80 us of software, a combining operation on the control
  network 5 us for integers, 25 us for floats.
* Y. A. Teng, F. Sullivan, I. Beichl, E. Puppo, Supercomputing '93, 112-121, Table 1: the times that
  "calibrated" refers to.
* G. E. Blelloch, Scans as Primitive Parallel Operations, IEEE Transactions on Computers 38, 1989: a scan of
  the CM takes about 550 bit cycles, a reference through the router about 600.
"""

from __future__ import annotations

from collections.abc import Mapping

from ._entry import Entry
from ._model import CALIBRATED, ESTIMATE, SOURCED, Constant, Model, used_processors
from ._pram import local_scan

TABLE1 = "Teng et al. 1993, Table 1, random sets, 32 nodes; `dt3d experiment table1` fits it anew"


def _cm5(entry: Entry, processors: int, c: Mapping[str, float]) -> float:
    compute = entry.operations * (c["issue"] + entry.vp_ratio * c["element"])
    if entry.primitive == "map":
        return compute
    if entry.primitive == "scan":
        across = c["combine"] if used_processors(entry) > 1 else 0.0
        return entry.operations * (c["issue"] + local_scan(entry) * c["element"] + across)
    packets = -(-entry.bytes // c["payload"])
    if entry.primitive == "get":
        packets = (1 + packets) / 2  # of a request and its reply, the request fits into one
    return compute + entry.busiest * (c["message"] + packets * c["packet"])


CM5 = Model(
    "CM5",
    "SPARC nodes without vector units; packets over a fat tree; a control network that scans. A step issues "
    "its operations, loops over the busiest node's elements, and handles the busiest node's packets",
    _cm5,
    {
        "issue": Constant(5.39e-5, "s an operation", CALIBRATED, TABLE1),
        "element": Constant(4.70e-6, "s an operation and element", CALIBRATED, TABLE1),
        "packet": Constant(
            4e-6, "s a packet", SOURCED, "Culler et al. 1993 (twice 2 us; 20 bytes at 5 MB/s)"
        ),
        "payload": Constant(16, "bytes a packet", SOURCED, "Culler et al. 1993"),
        "message": Constant(
            0.0, "s a message", ESTIMATE, "software beyond its packets: 0 at least, 8e-5 in CMMD"
        ),
        "combine": Constant(
            5e-6, "s a scan", SOURCED, "CMMD 3.1: an integer combined by the control network"
        ),
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
