"""The paper's tables as pure functions, and the holes and fronts they are measured on.

In: what a stage made, and the truth. Out: figures.
Paper: section 4 and its appendix. A module a table: open the stage's own.
It hands on nothing: who measures names the module, as a table is named.
"""
