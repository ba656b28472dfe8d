"""A parameter study in pandas: restitution factor over speed and axial load."""

import matplotlib.pyplot as plt
import numpy as np

import separatrix

study = separatrix.read_study("cryogenic-turbopump")
ranges = "operation.inner_speed=5000..30000rpm:6", "operation.axial_load=1000..5000N:3"
table = separatrix.sweep(study, ranges, jobs=2).to_dataframe()
table["speed [rpm]"] = (table["operation.inner_speed"] * 30 / np.pi).round()
table["load [N]"] = table["operation.axial_load"]
factors = table.pivot_table(index="speed [rpm]", columns="load [N]", values="restitution_factor")
print(factors.round(3))
print(table[["max_pressure_inner", "race_damping"]].describe().round())

at_full_speed = factors.loc[15000.0].tolist()
figure, axes = plt.subplots(layout="constrained")
factors.plot(ax=axes, marker="o")
axes.set_ylabel("restitution factor [-]")
