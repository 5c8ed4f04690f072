"""
The life of an oil
==================

Dust of a quarry enters 200 L of oil, 125 mg each hour. Three filters of one flow hold it back,
and the code that the oil comes to says which of them is enough: all of it passes the filter every
three minutes, so that a finer one than the usual changes little. Above, steps are the code and thin
lines the counts, with their scale on the right. Below, widths are masses.
"""

from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.views.plot.life import draw_flows, draw_history

quartz = tb.materials["quartz"]
sheets = {
    "coarse": tb.oil.Filter.from_text("4=1.5, 10=10, 20=75"),
    "usual": tb.oil.Filter.from_text("4=5, 7=75, 14=1000"),
    "fine": tb.oil.Filter.from_text("2.5=5, 4=75, 7=1000"),
}
oil = tb.oil.OilCircuit(
    volume=0.2,
    start=tb.oil.OilDirt.from_iso4406("20/18/15", material=quartz),
    ingress=tb.oil.Ingress.of_dust("A3-lot", rate="125 mg/h", material=quartz),
)
histories = {
    name: tb.life(
        oil=oil.replace(filters=sheet.replace(flow=1e-3, capacity=0.05)),
        duration=500 * 3600.0,
    )
    for name, sheet in sheets.items()
}
for name, history in histories.items():
    print(f"{name:7} {history.steady()[0].code}")

figure = Figure(figsize=(6.4, 7.2), layout="constrained")
axes = figure.subplots(2, 1)
draw_history(axes[0], histories["usual"])
draw_flows(axes[1], histories["usual"])

# what is in the oil and in the filters is what came
assert all(history.ledger.residual < 1e-9 for history in histories.values())
# a finer filter leaves a cleaner oil
counts = [history.counts[-1, 0] for history in histories.values()]
assert counts == sorted(counts, reverse=True)
