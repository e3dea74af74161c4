/*+++
title = "t"
source = "s"
kind = "stochastic"
[param.taps]
default = 16
min = 1
max = 64
choices = [4, 8, 16]
const = true
text = "help"
[param.way]
default = "a"
choices = ["a", "b"]
text = "help"
[disk.points]
count = "taps"
seed = 7
+++*/
float visibility(Receiver r) { return 1.0; }
