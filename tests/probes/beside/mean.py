"""The mean of the sensors: a voter of one's own."""


class Mean:
    about = "mean of the sensors"

    def vote(self, sensors):
        voted = sensors[0]
        for row in sensors[1:]:
            voted = voted + row
        return voted / float(len(sensors))
