"""From the evidence of an ensemble to a verdict: the judgement, its sentences, the ball it rests on."""
