"""A parameter study in pandas: restitution factor over speed and axial load."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
rpm = np.pi / 30
cases = [
    {"operation.inner_speed": speed * rpm, "operation.axial_load": load}
    for speed in (5e3, 10e3, 15e3, 20e3, 30e3)
    for load in (1000.0, 3000.0, 6000.0)
]
table = separatrix.sweep(study, cases, runner=separatrix.Runner(jobs=2)).to_dataframe()
table["speed [rpm]"] = (table["operation.inner_speed"] / rpm).round()
table["load [N]"] = table["operation.axial_load"]
factors = table.pivot_table(index="speed [rpm]", columns="load [N]", values="restitution_factor")
print(factors.round(3))
print(table[["max_pressure_inner", "race_damping"]].describe().round())

at_full_speed = factors.loc[15000.0].tolist()
figure, axes = plt.subplots(layout="constrained")
factors.plot(ax=axes, marker="o")
axes.set_ylabel("restitution factor [-]")
